// Differential positions from a base that was recorded too.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "canyon/gnss/rinex/observation/observation_writer.h"
#include "canyon/gnss/single_point/single_point.h"
#include "canyon/tests/gnss/sensor/synthetic_sky.h"

namespace canyon::gnss {
namespace {

const Eigen::Vector3d kRover = ecef_from_geodetic({52.0 * kDegree, 13.0 * kDegree, 120.0});
const Eigen::Vector3d kBase = ecef_from_geodetic({52.05 * kDegree, 13.08 * kDegree, 90.0});

class BaseStationTest : public ::testing::Test {
 protected:
  using Change = std::function<void(int, GnssEpoch&)>;
  ObservationFile file(const std::string& name, const Eigen::Vector3d& p_E, double from_s, double step_s, int epochs,
                       const Change& change, double clock_step_s = 0.0) const {
    const auto constellation = make_broadcast(navigation_);
    const GpsTime first = kSyntheticNoon + from_s;
    ObservationWriter writer(
        {.first = first, .approx_position_E = p_E, .bands = {{GnssSystem::kGps, {1}}, {GnssSystem::kGlonass, {1}}}});
    std::string text = writer.header();
    for (int k = 0; k < epochs; ++k) {
      SyntheticReceiver receiver{*constellation};
      receiver.clock_s = k % 2 * clock_step_s;
      auto epoch = receiver.at(first + step_s * k, p_E, Eigen::Vector3d::Zero());
      change(k, epoch);
      text += writer.epoch(epoch);
    }
    return *parse_observation_file(text, name);
  }
  /// What both receivers see of a satellite: up to 25 m.
  static double common_m(SatelliteId sv) { return 25.0 * std::sin(1.0 + 2.3 * sv.prn); }
  static void add_common(int, GnssEpoch& e) {
    for (auto& o : e.observations) o.pseudorange_m += common_m(o.sv);
  }
  static SinglePointConfig plain() {
    SinglePointConfig c;
    c.systems = "GR";
    c.ionosphere = IonosphereCorrection::kNone;
    c.troposphere = "none";
    c.smoothing_s = 0.0;
    c.fault_exclusion = "none";
    return c;
  }
  Result<SinglePointResult> solve(const ObservationFile& rover, const BaseRecording* base,
                                  const SinglePointConfig& config = plain()) const {
    return solve_observations(rover, {*make_broadcast(navigation_), navigation_, nullptr, base}, config);
  }

  const NavigationData navigation_ = synthetic_navigation();
};

// Pseudoranges are rounded to 0.5 mm in either file: times sqrt(2) and the sum over a dozen satellites of the gain,
// PDOP below 5, 5 mm. By itself the rover is metres off.
TEST_F(BaseStationTest, WhatBothSeeIsTakenAwayWhateverTheBasesClockDoes) {
  const auto rover = file("rover.rnx", kRover, 30.0, 10.0, 12, add_common);
  const BaseRecording base{file("base.rnx", kBase, 30.0, 10.0, 12, add_common, 1e-3), kBase};
  const auto alone = solve(rover, nullptr), together = solve(rover, &base);
  ASSERT_TRUE(alone.ok() && together.ok()) << together.error().str();
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_GT((alone->epochs[k].fix.p_A_E - kRover).norm(), 3.0);
    const GnssFix& fix = together->epochs[k].fix;
    ASSERT_EQ(fix.status, FixStatus::kDifferential) << fix.reason;
    EXPECT_LT((fix.p_A_E - kRover).norm(), 0.005);
  }
}

// 2026-11-26: the base's clock was left in the differences. The ranges of a rover with a filter then drifted by the
// rover's clock less the base's, here 0.6 m/s, its Dopplers by the rover's alone, 3 m/s, and the filter was 4 m off.
// Now the base's clock does not matter, nor where it steps by a millisecond or a satellite rises at the base.
TEST_F(BaseStationTest, AFilterFindsItsOwnClockInRangesAndDopplers) {
  const auto constellation = make_broadcast(navigation_);
  const auto drifting = [&](const std::string& name, const Eigen::Vector3d& p_E, double drift, double step_s,
                            double mask_deg) {
    const GpsTime first = kSyntheticNoon + 30.0;
    ObservationWriter writer(
        {.first = first, .approx_position_E = p_E, .bands = {{GnssSystem::kGps, {1}}, {GnssSystem::kGlonass, {1}}}});
    std::string text = writer.header();
    for (int k = 0; k < 120; ++k) {
      SyntheticReceiver receiver{*constellation, mask_deg};
      receiver.drift = drift;
      receiver.clock_s = drift * k + (k / 40) * step_s;
      auto epoch = receiver.at(first + 1.0 * k, p_E, Eigen::Vector3d::Zero());
      add_common(k, epoch);
      text += writer.epoch(epoch);
    }
    return *parse_observation_file(text, name);
  };
  const auto rover = drifting("rover.rnx", kRover, 1e-8, 0.0, 5.0);
  const BaseRecording base{drifting("base.rnx", kBase, 8e-9, 1e-3, 12.0), kBase};
  auto config = plain();
  config.estimator = Estimator::kKalman;
  const auto r = solve(rover, &base, config);
  ASSERT_TRUE(r.ok()) << r.error().str();
  for (const auto& e : r->epochs) {
    ASSERT_EQ(e.fix.status, FixStatus::kDifferential) << e.fix.reason;
    EXPECT_EQ(e.excluded, 0);
    EXPECT_LT((e.fix.p_A_E - kRover).norm(), 0.005);  // rounding of ranges, as above
    EXPECT_LT(e.fix.v_A_E.norm(), 0.005);             // of Dopplers to 1 mHz: 0.2 mm/s, times the gain
  }
}

// The median of the first system's differences, from all; so an outlier moves nothing, and an even number takes the
// middle of two.
TEST(TakeOutClockTest, IsTheMedianOfTheFirstSystem) {
  BaseDifferences::Epoch epoch{kSyntheticNoon, {}};
  EXPECT_EQ(take_out_clock(epoch), 0.0);
  const SatelliteId g1{GnssSystem::kGps, 1}, g2{GnssSystem::kGps, 2}, r1{GnssSystem::kGlonass, 1};
  epoch.satellites = {{r1, {7.0, 1, 0.5}}};
  EXPECT_EQ(take_out_clock(epoch), 7.0);
  epoch.satellites = {{g1, {100.0, 1, 0.5}}, {g2, {103.0, 1, 0.5}}, {r1, {90.0, 1, 0.5}}};
  EXPECT_EQ(take_out_clock(epoch), 101.5);
  EXPECT_EQ(epoch.satellites[g1].m, -1.5);
  EXPECT_EQ(epoch.satellites[r1].m, -11.5);
  epoch.satellites = {{g1, {1.0, 1, 0.5}}, {g2, {2.0, 1, 0.5}}, {{GnssSystem::kQzss, 1}, {1e4, 1, 0.5}}};
  EXPECT_EQ(take_out_clock(epoch), 2.0) << "QZSS keeps the time of GPS";
}

// A base every 60 s serves epochs within the age only; the others have no fix, and say why.
TEST_F(BaseStationTest, DifferencesAgeAndThenThereIsNoFix) {
  const auto rover = file("rover.rnx", kRover, 30.0, 10.0, 12, add_common);
  const BaseRecording base{file("base.rnx", kBase, 30.0, 60.0, 2, add_common), kBase};
  auto config = plain();
  config.base_age_s = 20.0;
  const auto r = solve(rover, &base, config);
  ASSERT_TRUE(r.ok()) << r.error().str();
  for (std::size_t k = 0; k < 12; ++k) {
    const bool near = k <= 2 || (k >= 4 && k <= 8);  // of the base's epochs at 30 and 90 s
    EXPECT_EQ(r->epochs[k].fix.status, near ? FixStatus::kDifferential : FixStatus::kNone) << k;
  }
  EXPECT_EQ(r->reasons.at("the base observed nothing near that time"), 12 - 8);
}

TEST_F(BaseStationTest, ABaseOfAnotherTimeOrOfOtherSatellitesIsRefused) {
  const auto rover = file("rover.rnx", kRover, 30.0, 10.0, 12, add_common);
  const BaseRecording late{file("base.rnx", kBase, 1230.0, 10.0, 12, add_common), kBase};
  const auto none = solve(rover, &late);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().str(),
            "base.rnx: has epochs from 2020-06-25T12:20:30 to 2020-06-25T12:22:20, none near those of rover.rnx, "
            "2020-06-25T12:00:30 to 2020-06-25T12:02:20, expected a base that observed at the same time");
  const auto only = [](GnssSystem system) {
    return [system](int, GnssEpoch& e) {
      std::erase_if(e.observations, [system](const GnssObservation& o) { return o.sv.system != system; });
    };
  };
  const auto gps = file("rover.rnx", kRover, 30.0, 10.0, 12, only(GnssSystem::kGps));
  const BaseRecording glonass{file("base.rnx", kBase, 30.0, 10.0, 12, only(GnssSystem::kGlonass)), kBase};
  const auto other = solve(gps, &glonass);
  ASSERT_FALSE(other.ok());
  EXPECT_EQ(other.error().str(),
            "base.rnx: has no satellite in common with rover.rnx from 2020-06-25T12:00:30 to 2020-06-25T12:02:20, "
            "expected a base near by that observed the same systems and bands");
}

// A base in the rover's own place with the rover's own observations is off by what the rover is: the position is the
// base's, to rounding of ranges.
TEST_F(BaseStationTest, AReceiverIsWhereItsBaseIsSaidToBe) {
  const auto rover = file("rover.rnx", kRover, 30.0, 10.0, 12, add_common);
  const Eigen::Vector3d said = kRover + Eigen::Vector3d(3.0, -2.0, 1.0);
  const BaseRecording base{rover, said};
  const auto r = solve(rover, &base);
  ASSERT_TRUE(r.ok());
  for (const auto& e : r->epochs) EXPECT_LT((e.fix.p_A_E - said).norm(), 1e-4);
}

}  // namespace
}  // namespace canyon::gnss
