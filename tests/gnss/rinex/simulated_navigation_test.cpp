#include "canyon/gnss/rinex/navigation/simulated_navigation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/rinex/navigation/navigation_writer.h"
#include "canyon/tests/gnss/rinex/nav_text.h"

namespace canyon::gnss {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::sample_ephemeris;

const GpsTime kStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

/// What a reader of the written file sees of each satellite, at most this far from what was simulated, over an hour.
double worst_m(const Constellation& simulated, const std::string& text, double* worst_m_s = nullptr) {
  const auto back = parse_navigation_file(text, "w.nav");
  EXPECT_TRUE(back.ok());
  EXPECT_TRUE(back->warnings.empty()) << back->warnings.front();
  const auto read = make_broadcast(*back);
  double out = 0.0;
  for (const SatelliteId sv : simulated.satellites())
    for (double s = 0.0; s <= 3600.0; s += 100.0) {
      const auto want = simulated.state(sv, kStart + s), got = read->state(sv, kStart + s);
      EXPECT_EQ(want.has_value(), got.has_value()) << sv.str() << " " << s;
      if (!want || !got) continue;
      out = std::max(out, (got->p_E - want->p_E).norm());
      EXPECT_EQ(got->frequency_channel, want->frequency_channel);
      if (worst_m_s != nullptr) *worst_m_s = std::max(*worst_m_s, (got->v_E - want->v_E).norm());
    }
  return out;
}

// Every satellite of the built-in constellations of all systems stands in the file that is written with them.
TEST(SimulatedNavigation, BuiltInConstellationsOfAllSystems) {
  const auto nominal = make_nominal("GRECJ");
  const auto simulated = simulated_navigation(*nominal, {}, "GRECJ", kStart, kStart + 3600.0);
  ASSERT_TRUE(simulated.ok()) << simulated.error().str();
  EXPECT_THAT(simulated->warnings, ElementsAre());
  double rate_m_s = 0.0;
  EXPECT_LT(worst_m(*nominal, *navigation_file_text(simulated->data), &rate_m_s), 0.01);
  EXPECT_LT(rate_m_s, 1e-4);
}

// RINEX 3 has no records for almanacs and B-CNAV: such satellites get fitted ones.
TEST(SimulatedNavigation, WhatRinex3HasNoRecordForIsFitted) {
  NavigationData data;
  KeplerEphemeris almanac = sample_ephemeris(1, kStart);
  almanac.message = NavigationMessage::kAlmanac;
  almanac.valid_before_s = almanac.valid_after_s = 14.0 * 86400.0;
  KeplerEphemeris beidou = sample_ephemeris(30, kStart + 1800.0);
  beidou.sv.system = GnssSystem::kBeidou;
  beidou.message = NavigationMessage::kBcnav1;
  beidou.valid_before_s = beidou.valid_after_s = 3.0 * 3600.0;
  KeplerEphemeris broken = sample_ephemeris(3, kStart + 1800.0);
  broken.toc = broken.toc + 0.5;
  data.kepler = {almanac, beidou, broken, sample_ephemeris(2, kStart)};
  const auto constellation = make_broadcast(data);
  const auto simulated = simulated_navigation(*constellation, data, "GC", kStart, kStart + 3600.0);
  ASSERT_TRUE(simulated.ok()) << simulated.error().str();
  EXPECT_THAT(simulated->warnings, ElementsAre());
  EXPECT_LT(worst_m(*constellation, *navigation_file_text(simulated->data)), 0.01);
}

/// Satellites that no record can follow: one that turns too fast, one that is there for too short a time.
class Impossible final : public Constellation {
 public:
  Impossible(SatelliteId sv, double seconds) : satellites_{sv}, seconds_(seconds) {}
  const std::vector<SatelliteId>& satellites() const override { return satellites_; }
  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    const double s = t - kStart;
    if (sv != satellites_[0] || s < 0.0 || s > seconds_) return std::nullopt;
    SatelliteState out = sample_ephemeris(1, kStart).at(t);
    if (seconds_ > 3600.0) out.p_E.z() += 1000.0 * std::sin(s / 300.0);
    return out;
  }

 private:
  std::vector<SatelliteId> satellites_;
  double seconds_;
};

TEST(SimulatedNavigation, WhatCannotBeWrittenIsTold) {
  const SatelliteId g07{GnssSystem::kGps, 7};
  const auto brief = simulated_navigation(Impossible(g07, 600.0), {}, "G", kStart, kStart + 3600.0);
  ASSERT_TRUE(brief.ok());
  EXPECT_THAT(brief->warnings, ElementsAre("G07 was simulated, but no navigation record describes it"));
  const auto wild = simulated_navigation(Impossible(g07, 90000.0), {}, "G", kStart + 7200.0, kStart + 10800.0);
  ASSERT_FALSE(wild.ok());
  EXPECT_EQ(wild.error().exit_code, 1);
  EXPECT_THAT(wild.error().str(), HasSubstr("G07: at 2010-11-17T15:00:00 its navigation record is "));
  EXPECT_THAT(wild.error().str(), HasSubstr(" m from the orbit that was simulated, expected at most 1 m"));
}

TEST(NavigationWriter, AFractionOfASecondIsAnError) {
  NavigationData data;
  data.files.push_back({"given.nav", 2.11});
  data.kepler.push_back(sample_ephemeris(5, kStart));
  data.kepler.back().toc = kStart + 0.5;
  const auto text = navigation_file_text(data);
  ASSERT_FALSE(text.ok());
  EXPECT_EQ(text.error().str(),
            "given.nav: G05: the epoch 2010-11-17T13:00:00.500000000 cannot be written, expected a whole second, as "
            "RINEX 3 has it");
}

}  // namespace
}  // namespace canyon::gnss
