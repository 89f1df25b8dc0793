#include "canyon/gnss/products/precise_orbits.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/signal.h"
#include "canyon/tests/gnss/atmosphere/product_text.h"
#include "canyon/tests/gnss/rinex/damage.h"
#include "canyon/tests/gnss/rinex/nav_text.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using testing::broadcast_of;
using ::testing::ElementsAre;
using testing::periodic_relativity_s;
using testing::sample_ephemeris;
using testing::sp3_text;

const GpsTime kStart = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);
const SatelliteId kG01{GnssSystem::kGps, 1};

/// Two satellites whose one record holds for six hours: an orbit that is smooth by construction.
std::unique_ptr<Constellation> smooth_truth() {
  auto first = sample_ephemeris(1, kStart + 10800.0), second = sample_ephemeris(9, kStart + 10800.0);
  for (auto* r : {&first, &second}) r->valid_before_s = r->valid_after_s = 5.0 * 3600.0;
  return broadcast_of({first, second});
}

PreciseOrbits parsed(const std::string& text) {
  auto orbits = parse_sp3_file(text, "igs.sp3");
  EXPECT_TRUE(orbits.ok()) << orbits.error().str();
  return *std::move(orbits);
}

std::string error_of(const std::string& text) {
  const auto orbits = parse_sp3_file(text, "igs.sp3");
  return orbits.ok() ? "no error" : orbits.error().str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Positions are written to 1 mm, clocks to 1 ps: half a unit each.
TEST(Sp3, GivesBackWhatWasWritten) {
  const auto truth = smooth_truth();
  const PreciseOrbits orbits = parsed(sp3_text(*truth, kStart, 900.0, 24, "GPS", true));
  EXPECT_EQ(orbits.interval_s, 900.0);
  EXPECT_TRUE(orbits.warnings.empty());
  ASSERT_EQ(orbits.satellites.size(), 2u);
  const auto& samples = orbits.satellites.at(kG01);
  ASSERT_EQ(samples.size(), 24u);
  for (const PreciseSample& s : samples) {
    const auto want = truth->state(kG01, s.t);
    ASSERT_TRUE(want.has_value());
    EXPECT_LT((s.p_E - want->p_E).cwiseAbs().maxCoeff(), 0.51e-3);
    EXPECT_LT((*s.v_E - want->v_E).cwiseAbs().maxCoeff(), 0.51e-7);
    EXPECT_NEAR(s.clock_s, want->clock_s - periodic_relativity_s(*want), 0.51e-12);
  }
}

TEST(Sp3, TimeSystems) {
  const auto truth = smooth_truth();
  const auto first = [&](const std::string& system) {
    return parsed(sp3_text(*truth, kStart, 900.0, 3, system)).satellites.at(kG01).front().t - kStart;
  };
  EXPECT_EQ(first("GPS"), 0.0);
  EXPECT_EQ(first("GAL"), 0.0);
  EXPECT_EQ(first("BDT"), 14.0);
  EXPECT_EQ(first("UTC"), 15.0);  // in 2010
  EXPECT_EQ(first("TAI"), -19.0);
  const auto strange = parsed(sp3_text(*truth, kStart, 900.0, 3, "XYZ"));
  EXPECT_THAT(strange.warnings, ElementsAre("igs.sp3:4: time system \"XYZ\" is not known, GPS assumed"));
}

// Degree 9 in steps of 900 s on an orbit of 43,000 s: the next term is 10th differences of the position, about
// r (w h)^10 / 10! times the window's product; in the middle of ten points that is below 1 mm, beside the 0.5 mm of the
// file. At the ends the product is 60 times larger.
TEST(PreciseConstellation, InterpolatesPositionAndVelocity) {
  const auto truth = smooth_truth();
  const auto precise = make_precise(parsed(sp3_text(*truth, kStart, 900.0, 24)));
  for (double s = -449.0; s < 23.0 * 900.0 + 450.0; s += 111.0) {
    const GpsTime t = kStart + s;
    const auto want = truth->state(kG01, t), got = precise->state(kG01, t);
    ASSERT_TRUE(want && got) << s;
    const bool inside = s > 4.0 * 900.0 && s<19.0 * 900.0, between = s> 0.0 && s < 23.0 * 900.0;
    EXPECT_LT((got->p_E - want->p_E).norm(), inside ? 2e-3 : between ? 0.05 : 0.3) << s;
    EXPECT_LT((got->v_E - want->v_E).norm(), inside ? 1e-5 : between ? 1e-3 : 1e-2) << s;
    // The clock without relativity is a parabola with 1e-20 /s^2 h^2 / 8; the file has 1 ps.
    EXPECT_NEAR(got->clock_s, want->clock_s, 2e-12 + (between ? 0.0 : 1e-11)) << s;
    // The derivative of the relativity leaves out what perturbs the orbit, at most 6e-5 m/s^2: 2 r a / c^2.
    EXPECT_NEAR(got->clock_rate, want->clock_rate, 4e-14) << s;
  }
  EXPECT_FALSE(precise->state(kG01, kStart - 451.0).has_value());
  EXPECT_FALSE(precise->state(kG01, kStart + (23.0 * 900.0 + 451.0)).has_value());
  EXPECT_FALSE(precise->state({GnssSystem::kGps, 2}, kStart + 3600.0).has_value());
}

TEST(PreciseConstellation, VelocityIsTheDerivative) {
  const auto precise = make_precise(parsed(sp3_text(*smooth_truth(), kStart, 900.0, 24)));
  for (double s = 500.0; s < 20000.0; s += 777.0) {
    const auto now = precise->state(kG01, kStart + s), before = precise->state(kG01, kStart + (s - 0.5)),
               after = precise->state(kG01, kStart + (s + 0.5));
    // Third derivative / 24 is 4e-6 m here, 1 ns of time 4e-6 m.
    EXPECT_LT((after->p_E - before->p_E - now->v_E).norm(), 2e-5) << s;
    EXPECT_NEAR(after->clock_s - before->clock_s, now->clock_rate, 4e-14) << s;  // as above
  }
}

TEST(PreciseConstellation, GapsAreNotBridged) {
  const auto truth = smooth_truth();
  PreciseOrbits orbits = parsed(sp3_text(*truth, kStart, 900.0, 24));
  auto& samples = orbits.satellites.at(kG01);
  samples.erase(samples.begin() + 11);  // 11 before, 12 after
  const auto gap = make_precise(orbits);
  const auto at = [&](double epoch) { return gap->state(kG01, kStart + 900.0 * epoch).has_value(); };
  EXPECT_TRUE(at(10.0) && at(10.49) && at(11.51) && at(12.0));
  EXPECT_FALSE(at(10.51) || at(11.0) || at(11.49));
  samples.erase(samples.begin() + 14);  // what is left after the gap is too short
  const auto short_runs = make_precise(orbits);
  EXPECT_TRUE(short_runs->state(kG01, kStart + 900.0 * 5.0).has_value());
  EXPECT_FALSE(short_runs->state(kG01, kStart + 900.0 * 13.0).has_value());
}

TEST(PreciseConstellation, UnknownClocksAndJumps) {
  const auto truth = smooth_truth();
  PreciseOrbits orbits = parsed(sp3_text(*truth, kStart, 900.0, 24));
  orbits.satellites.at(kG01)[8].clock_s = kNaN;
  orbits.satellites.at(kG01)[12].clock_event = true;
  const auto precise = make_precise(orbits);
  const auto at = [&](double epoch) { return precise->state(kG01, kStart + 900.0 * epoch).has_value(); };
  EXPECT_TRUE(at(7.0) && at(9.0) && at(11.0) && at(12.0) && at(12.5));
  EXPECT_FALSE(at(7.5) || at(8.0) || at(8.5) || at(11.5));
}

TEST(Sp3, UnknownValuesAreLeftOut) {
  const auto truth = smooth_truth();
  std::string text = sp3_text(*truth, kStart, 900.0, 3);
  const std::size_t row = text.find("PG01");
  text.replace(row + 4, 42, "      0.000000      0.000000      0.000000");
  const std::size_t second = text.find("PG09");
  text.replace(second + 46, 14, " 999999.999999");
  const PreciseOrbits orbits = parsed(text);
  EXPECT_EQ(orbits.satellites.at(kG01).size(), 2u);
  EXPECT_TRUE(std::isnan(orbits.satellites.at({GnssSystem::kGps, 9}).front().clock_s));
  EXPECT_TRUE(orbits.warnings.empty());
}

TEST(Sp3, SeveralFilesAreJoined) {
  const auto truth = smooth_truth();
  PreciseOrbits all = parsed(sp3_text(*truth, kStart, 900.0, 13));
  PreciseOrbits next = parsed(sp3_text(*truth, kStart + 12.0 * 900.0, 900.0, 12));
  all.satellites.at(kG01).back().clock_s = kNaN;  // the first epoch of the next file knows it
  all.append(next);
  ASSERT_EQ(all.satellites.at(kG01).size(), 24u);
  for (const auto& s : all.satellites.at(kG01)) EXPECT_FALSE(std::isnan(s.clock_s));
  // Across the seam the ten points come from both files.
  const GpsTime t = kStart + 11.5 * 900.0;
  EXPECT_LT((make_precise(all)->state(kG01, t)->p_E - truth->state(kG01, t)->p_E).norm(), 2e-3);
}

TEST(Sp3, ErrorsWordForWord) {
  const std::string good = sp3_text(*smooth_truth(), kStart, 900.0, 2);
  EXPECT_EQ(error_of(""), "igs.sp3:1: the file is empty, expected an SP3 file of version a, b, c or d");
  EXPECT_EQ(
      error_of("#eP2010\n"),
      "igs.sp3:1: not an SP3 file: the first line does not start with \"#cP\" or its like, expected an SP3 file of "
      "version a, b, c or d");
  EXPECT_EQ(error_of("#cP2010\n"),
            "igs.sp3:2: the second line does not start with \"##\", expected an SP3 file of version a, b, c or d");
  EXPECT_EQ(error_of(replaced(good, "  900.00000000", "  9x0.00000000")),
            "igs.sp3:2: the epoch interval cannot be read, expected seconds, in columns 25 to 38");
  EXPECT_EQ(error_of(good.substr(0, good.find("PG01"))),
            "igs.sp3:6: no satellite position, expected an SP3 file of version a, b, c or d");
}

TEST(Sp3, DamagedLinesAreSkippedWithTheirNumber) {
  const std::string good = sp3_text(*smooth_truth(), kStart, 900.0, 2);
  const auto warnings_of = [](const std::string& text) { return parsed(text).warnings; };
  EXPECT_THAT(warnings_of(replaced(good, "PG01", "PG0x")),
              ElementsAre("igs.sp3:7: satellite \"G0x\" cannot be read; skipped"));
  EXPECT_THAT(warnings_of(replaced(good, "PG09", "PG01")),
              ElementsAre("igs.sp3:8: G01 stands twice in this epoch; the second is skipped"));
  EXPECT_THAT(warnings_of(replaced(good, "*  2010  7  1  0  0", "*  2010 17  1  0  0")),
              ElementsAre("igs.sp3:6: the epoch cannot be read; its satellites are skipped"));
  EXPECT_THAT(warnings_of(replaced(good, "EOF\n", "")),
              ElementsAre("igs.sp3:11: the file ends without \"EOF\": it may be truncated"));
  EXPECT_TRUE(warnings_of(replaced(good, "PG09", "PI09")).empty());  // another system
}

TEST(Sp3, SurvivesDamage) {
  const std::string text = sp3_text(*smooth_truth(), kStart, 900.0, 12, "GPS", true);
  const auto read = [](const std::string& damaged) {
    const auto orbits = parse_sp3_file(damaged, "damaged.sp3");
    if (!orbits.ok()) return;
    const auto precise = make_precise(*orbits);
    for (const SatelliteId sv : precise->satellites())
      for (const double s : {0.0, 3000.0, 9000.0})
        if (const auto state = precise->state(sv, kStart + s)) {
          EXPECT_TRUE(state->p_E.allFinite() && state->v_E.allFinite());
        }
  };
  testing::for_each_truncation(text, read);
  testing::for_each_damage(text, 300, 20, read);
}

// NGA's 5-minute orbits with velocities (SP3-a): every third epoch interpolated to the other two and to the velocities.
TEST(PreciseConstellation, RealOrbitsWithVelocities) {
  CANYON_REAL_DATA(path, "gnss/arl_2015_200/nga18540_5min.sp3.gz");
  const auto full = read_sp3_file(path);
  ASSERT_TRUE(full.ok()) << full.error().str();
  EXPECT_TRUE(full->warnings.empty());
  PreciseOrbits thin = *full;
  thin.interval_s = 900.0;
  for (auto& [sv, samples] : thin.satellites) {
    std::vector<PreciseSample> kept;
    for (std::size_t i = 0; i < samples.size(); i += 3) kept.push_back(samples[i]);
    samples = kept;
  }
  const auto precise = make_precise(thin);
  double position2 = 0.0, velocity2 = 0.0, worst_m = 0.0;
  int n = 0;
  for (const auto& [sv, samples] : full->satellites)
    for (std::size_t i = 15; i + 15 < samples.size(); ++i) {
      const auto state = precise->state(sv, samples[i].t);
      ASSERT_TRUE(state.has_value());
      const double away_m = (state->p_E - samples[i].p_E).norm();
      position2 += away_m * away_m;
      velocity2 += (state->v_E - *samples[i].v_E).squaredNorm();
      worst_m = std::max(worst_m, away_m);
      ++n;
    }
  EXPECT_GT(n, 7000);
  EXPECT_LT(std::sqrt(position2 / n), 1e-3);  // measured 0.6 mm; the file is written to 1 mm
  EXPECT_LT(worst_m, 5e-3);
  EXPECT_LT(std::sqrt(velocity2 / n), 1e-4);  // measured 0.06 mm/s
}

// SP3 files do not tell GLONASS's channels: the observations' header does, else the broadcast, else the public plan.
TEST(PreciseConstellation, GlonassChannels) {
  NavigationData data;
  for (int slot = 1; slot <= 4; ++slot) {
    KeplerEphemeris r = sample_ephemeris(1, kStart + 10800.0);
    r.sv.prn = static_cast<std::uint8_t>(slot == 4 ? 26 : slot);
    r.valid_before_s = r.valid_after_s = 4.0 * 3600.0;
    data.kepler.push_back(r);
  }
  std::string text = sp3_text(*make_broadcast(data), kStart, 900.0, 24);
  for (std::size_t at = text.find("PG"); at != std::string::npos; at = text.find("PG", at)) text[at + 1] = 'R';
  NavigationData broadcast;
  for (const int slot : {1, 2}) {
    GlonassEphemeris g;
    g.sv = {GnssSystem::kGlonass, static_cast<std::uint8_t>(slot)};
    g.frequency_channel = 3;
    broadcast.glonass.push_back(g);
  }
  const auto precise = make_precise(parsed(text), {.broadcast = &broadcast, .glonass_channels = {{1, -6}}});
  const auto channel = [&](std::uint8_t slot) {
    return precise->state({GnssSystem::kGlonass, slot}, kStart + 10800.0)->frequency_channel;
  };
  EXPECT_EQ(channel(1), -6);
  EXPECT_EQ(channel(2), 3);
  EXPECT_EQ(channel(3), 5);  // the plan's
  EXPECT_EQ(channel(26), kUnknownChannel);
  EXPECT_TRUE(std::isnan(carrier_hz(GnssSystem::kGlonass, 1, kUnknownChannel)));
  EXPECT_EQ(carrier_hz(GnssSystem::kGlonass, 3, kUnknownChannel), 1202.025e6);  // CDMA
}

// A user of one frequency needs the broadcast group delays with any clock. For Galileo they come from I/NAV, whose
// clock is another one (E1, E5b): against a clock of E1 and E5a the delay of E1 must be BGD(E1, E5a) itself.
TEST(PreciseConstellation, GroupDelaysReferToThePreciseClock) {
  NavigationData data;
  KeplerEphemeris r = sample_ephemeris(1, kStart + 10800.0);
  r.sv.system = GnssSystem::kGalileo;
  r.message = NavigationMessage::kInav;
  r.tgd_s = 3e-9;
  r.tgd2_s = 4e-9;
  data.kepler.push_back(r);
  r.sv = {GnssSystem::kBeidou, 20};
  r.message = NavigationMessage::kD1;
  data.kepler.push_back(r);
  for (auto& k : data.kepler) k.valid_before_s = k.valid_after_s = 4.0 * 3600.0;
  const auto truth = make_broadcast(data);
  const auto precise = make_precise(parsed(sp3_text(*truth, kStart, 900.0, 24)), {.broadcast = &data});
  const auto e = precise->state({GnssSystem::kGalileo, 1}, kStart + 10800.0);
  ASSERT_TRUE(e.has_value());
  EXPECT_NEAR(e->group_delay_s[1], 3e-9, 1e-21);
  const auto c = precise->state({GnssSystem::kBeidou, 20}, kStart + 10800.0);
  ASSERT_TRUE(c.has_value());
  // B1I minus B3I stays TGD1, and their combination has no delay.
  EXPECT_NEAR(c->group_delay_s[2] - c->group_delay_s[6], 3e-9, 1e-21);
  const double f1 = 1561.098, f3 = 1268.52;
  EXPECT_NEAR(f1 * f1 * c->group_delay_s[2], f3 * f3 * c->group_delay_s[6], 1e-14);
}

}  // namespace
}  // namespace canyon::gnss
