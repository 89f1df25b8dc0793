#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/beidou_klobuchar.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/rinex/observation/observation_writer.h"
#include "canyon/gnss/single_point/position_statistics.h"
#include "canyon/gnss/single_point/single_point.h"
#include "canyon/gnss/single_point/solution_file.h"
#include "canyon/tests/gnss/atmosphere/product_text.h"
#include "canyon/tests/gnss/sensor/synthetic_sky.h"

namespace canyon::gnss {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The synthetic twin of the stations: atmosphere put on with the models that take it off again.
class SyntheticDay : public ::testing::Test {
 protected:
  const NavigationData navigation_ = synthetic_navigation();
  const Eigen::Vector3d place_ = ecef_from_geodetic({52.0 * kDegree, 13.0 * kDegree, 120.0});

  /// Twenty minutes of all systems on one band, with a change made to each epoch.
  ObservationFile file(const std::function<void(int, GnssEpoch&)>& change, int beidou_band = 2) const {
    return file_of(navigation_, change, beidou_band);
  }
  ObservationFile file_of(const NavigationData& navigation, const std::function<void(int, GnssEpoch&)>& change,
                          int beidou_band = 2) const {
    const auto constellation = make_broadcast(navigation);
    const GpsTime first = kSyntheticNoon + 30.0;
    ObservationWriter writer({.first = first,
                              .approx_position_E = place_,
                              .bands = {{GnssSystem::kGps, {1}},
                                        {GnssSystem::kGlonass, {1}},
                                        {GnssSystem::kGalileo, {1}},
                                        {GnssSystem::kBeidou, {beidou_band}}}});
    std::string text = writer.header();
    for (int k = 0; k < 40; ++k) {
      auto epoch = SyntheticReceiver{*constellation}.at(first + 30.0 * k, place_, Eigen::Vector3d::Zero());
      change(k, epoch);
      text += writer.epoch(epoch);
    }
    return *parse_observation_file(text, "synthetic.rnx");
  }
  static SinglePointConfig plain() {
    SinglePointConfig c;
    c.ionosphere = IonosphereCorrection::kNone;
    c.troposphere = "none";
    c.smoothing_s = c.shared_ionosphere = 0.0;
    return c;
  }
  Result<SinglePointResult> solve_file(const ObservationFile& f, const SinglePointConfig& c) const {
    return solve_observations(f, {*make_broadcast(navigation_), navigation_}, c);
  }
};

TEST_F(SyntheticDay, AFaultySatelliteIsExcludedAndTheFixStays) {
  const auto f = file([](int k, GnssEpoch& e) {
    if (k >= 10) e.observations[3].pseudorange_m += 120.0;
  });
  const auto r = solve_file(f, plain());
  ASSERT_TRUE(r.ok());
  for (std::size_t k = 0; k < 40; ++k) {
    const auto& e = r->epochs[k];
    ASSERT_EQ(e.fix.status, FixStatus::kSingle) << e.fix.reason;
    EXPECT_LT((e.fix.p_A_E - place_).norm(), 0.001 * e.fix.dop.pdop);
    EXPECT_EQ(e.excluded, k >= 10 ? 1 : 0);
    EXPECT_EQ(e.integrity.status, k >= 10 ? IntegrityTest::Status::kRepaired : IntegrityTest::Status::kPassed);
  }
}

TEST_F(SyntheticDay, SmoothingTakesNoiseAwayAndSurvivesSlips) {
  const RandomStream noise(5, "test.smoothing");
  const auto f = file([&](int k, GnssEpoch& e) {
    for (auto& o : e.observations) {
      o.pseudorange_m += noise.normal(o.sv.entity(), static_cast<std::uint64_t>(k));
      if (k >= 20 && o.sv.prn % 2 == 0) o.carrier_phase_cycles += 777.0;  // 150 m, not told
      if (k >= 30 && o.sv.prn % 2 == 1) o.carrier_phase_cycles += 20.0;   // 4 m, told
      o.slipped = k == 30 && o.sv.prn % 2 == 1;
    }
  });
  const auto rms = [&](double smoothing_s, std::size_t from, std::size_t to) {
    auto c = plain();
    c.smoothing_s = smoothing_s;
    const auto r = solve_file(f, c);
    double square = 0.0;
    for (std::size_t k = from; k < to; ++k) square += (r->epochs[k].fix.p_A_E - place_).squaredNorm();
    return std::sqrt(square / static_cast<double>(to - from));
  };
  // A mean of 10 to 20 independent values: 1/sqrt(10) = 0.32 and less of the noise, with room for the few epochs.
  EXPECT_LT(rms(600.0, 10, 20), 0.5 * rms(0.0, 10, 20));
  EXPECT_LT(rms(600.0, 20, 40), rms(0.0, 20, 40));  // slips of 150 m and of 4 m do no harm
}

// Two metres of noise: the filter, which has Doppler too, is better than each epoch by itself.
TEST_F(SyntheticDay, TheFilterIsBetterThanEpochsByThemselves) {
  const RandomStream noise(6, "test.kalman");
  const auto f = file([&](int k, GnssEpoch& e) {
    for (auto& o : e.observations) o.pseudorange_m += 2.0 * noise.normal(o.sv.entity(), static_cast<std::uint64_t>(k));
  });
  auto c = plain();
  c.sigma_m = 2.0;
  c.acceleration_m_s2 = 0.01;
  const auto rms = [&](Estimator estimator) {
    c.estimator = estimator;
    const auto r = solve_file(f, c);
    double square = 0.0;
    for (std::size_t k = 10; k < 40; ++k) square += (r->epochs[k].fix.p_A_E - place_).squaredNorm();
    return std::sqrt(square / 30.0);
  };
  EXPECT_LT(rms(Estimator::kKalman), 0.6 * rms(Estimator::kLeastSquares));
}

// Three satellites make no fix, but keep a running filter from drifting; none at all make none in either.
TEST_F(SyntheticDay, TheFilterBridgesEpochsWithFewSatellites) {
  const auto f = file([](int k, GnssEpoch& e) {
    if (k >= 10 && k < 13) e.observations.resize(3);
  });
  auto c = plain();
  c.systems = "G";
  c.acceleration_m_s2 = 0.01;
  const auto by_itself = solve_file(f, c);
  c.estimator = Estimator::kKalman;
  const auto filtered = solve_file(f, c);
  ASSERT_TRUE(by_itself.ok() && filtered.ok());
  EXPECT_EQ(by_itself->solved(), 37);
  EXPECT_EQ(filtered->solved(), 40);
  for (std::size_t k = 10; k < 13; ++k) {
    const GnssFix& fix = filtered->epochs[k].fix;
    ASSERT_EQ(fix.status, FixStatus::kSingle);
    EXPECT_EQ(fix.satellites, 3);
    EXPECT_TRUE(fix.reason.empty());
    // Fourth direction from what it knew: 0.01 m/s^2/sqrt(Hz) over 90 s is 0.01 sqrt(90^3 / 3) = 5 m.
    EXPECT_LT((fix.p_A_E - place_).norm(), 5.0);
    EXPECT_GT(fix.covariance_E.trace(), filtered->epochs[9].fix.covariance_E.trace());
  }
  EXPECT_LT((filtered->epochs[13].fix.p_A_E - place_).norm(), 1.0);
}

// 2026-11-22: a failed RAIM test kept the filter from bridging, and it was given only what the snapshot had kept.
TEST_F(SyntheticDay, TheFilterBridgesEpochsThatContradictThemselves) {
  const auto f = file([](int k, GnssEpoch& e) {
    if (k < 10 || k >= 13) return;
    // One of five: the test fails, and none of five can be told to be wrong with four left.
    e.observations.resize(5);
    e.observations[2].pseudorange_m += 200.0;
  });
  auto c = plain();
  c.systems = "G";
  c.acceleration_m_s2 = 0.01;
  c.fault_exclusion = "detect";
  c.estimator = Estimator::kKalman;
  const auto filtered = solve_file(f, c);
  ASSERT_TRUE(filtered.ok());
  EXPECT_EQ(filtered->solved(), 40);
  for (std::size_t k = 10; k < 13; ++k) {
    const auto& e = filtered->epochs[k];
    ASSERT_EQ(e.fix.status, FixStatus::kSingle) << e.fix.reason;
    EXPECT_EQ(e.fix.satellites, 4);
    EXPECT_FALSE(e.epoch.observations[2].used);
    EXPECT_LT((e.fix.p_A_E - place_).norm(), 1.0);
  }
}

/// What an SP3 file every 30 s says of these records.
PreciseOrbits orbits_of(const NavigationData& navigation) {
  return *parse_sp3_file(testing::sp3_text(*make_broadcast(navigation), kSyntheticNoon - 1140.0, 30.0, 79), "s.sp3");
}

// The precise twin of the stations. SP3 files do not tell GLONASS's channels; a wrong one would give velocities of
// metres per second, and let the smoothed ranges drift.
TEST_F(SyntheticDay, PreciseOrbitsOfGlonassKeepItsChannels) {
  const auto f = file([](int, GnssEpoch&) {});
  auto c = plain();
  c.systems = "R";
  c.smoothing_s = 300.0;
  const auto precise = make_precise(orbits_of(navigation_), {.broadcast = &navigation_});
  const auto r = solve_observations(f, {*precise, navigation_}, c);
  ASSERT_TRUE(r.ok()) << r.error().str();
  EXPECT_THAT(r->warnings, ElementsAre());
  // Positions in the file to 1 mm, clocks to 1 ps; the ten points spread the rounding of the last hardly further.
  for (std::size_t k = 0; k < 36; ++k) {
    ASSERT_EQ(r->epochs[k].fix.status, FixStatus::kSingle) << r->epochs[k].fix.reason;
    EXPECT_LT((r->epochs[k].fix.p_A_E - place_).norm(), 0.004 * r->epochs[k].fix.dop.pdop) << k;
    EXPECT_LT(r->epochs[k].fix.v_A_E.norm(), 0.003 * r->epochs[k].fix.dop.pdop) << k;
  }
}

TEST_F(SyntheticDay, AGlonassChannelThatNobodyTellsCostsPhaseAndDoppler) {
  auto navigation = navigation_;
  for (auto& g : navigation.glonass) g.sv.prn = static_cast<std::uint8_t>(g.sv.prn + 24);  // outside the public plan
  const auto f = file_of(navigation, [](int, GnssEpoch&) {});
  auto c = plain();
  c.systems = "R";
  c.smoothing_s = 300.0;
  const auto r = solve_observations(f, {*make_precise(orbits_of(navigation)), navigation}, c);
  ASSERT_TRUE(r.ok()) << r.error().str();
  ASSERT_EQ(r->warnings.size(), 1u);
  EXPECT_THAT(r->warnings[0], HasSubstr("synthetic.rnx:" + std::to_string(f.epochs.front().line) + ": R2"));
  EXPECT_THAT(r->warnings[0], HasSubstr(": no one tells the GLONASS channel; phase and Doppler are not used"));
  for (std::size_t k = 0; k < 36; ++k) {
    EXPECT_LT((r->epochs[k].fix.p_A_E - place_).norm(), 0.004 * r->epochs[k].fix.dop.pdop) << k;
    EXPECT_TRUE(std::isnan(r->epochs[k].fix.v_A_E.x()));
    for (const auto& o : r->epochs[k].epoch.observations) EXPECT_TRUE(std::isnan(o.carrier_phase_cycles));
  }
}

// D1 does not tell the group delay of B1C, the only BeiDou signal of many receivers; that of B1I is near.
TEST_F(SyntheticDay, B1cIsSolvedWithTheGroupDelayOfB1i) {
  const auto f = file(
      [](int, GnssEpoch& e) {
        for (auto& o : e.observations) {
          if (o.sv.system != GnssSystem::kBeidou) continue;
          o.band = 1;
          const double ratio = kL1Hz / carrier_hz(GnssSystem::kBeidou, 2);
          o.carrier_phase_cycles *= ratio;
          o.doppler_hz *= ratio;
        }
      },
      1);
  auto c = plain();
  c.systems = "C";
  c.max_gdop = 100.0;
  const auto r = solve_file(f, c);
  ASSERT_TRUE(r.ok()) << r.error().str();
  for (const auto& e : r->epochs) EXPECT_LT((e.fix.p_A_E - place_).norm(), 0.001 * e.fix.dop.pdop);
  ASSERT_EQ(r->warnings.size(), 1u);
  EXPECT_THAT(r->warnings[0], HasSubstr(": the navigation message does not tell this band's group delay; that of the "
                                        "band beside it is used, and its ranges count for less"));
  // They count for less: 3.3 ns on top.
  const auto plain_sigma_m = solve_file(file([](int, GnssEpoch&) {}), c)->epochs[0].epoch.observations[0].sigma_m;
  EXPECT_NEAR(r->epochs[0].epoch.observations[0].sigma_m, std::hypot(plain_sigma_m, 3.3e-9 * kSpeedOfLight), 1e-12);
}

// Each system's delays by its own coefficients and its own formula.
TEST_F(SyntheticDay, OwnKlobucharOfBeidou) {
  auto navigation = navigation_;
  const KlobucharCoefficients own{{2.1e-8, 7.4e-8, -5.0e-7, 8.0e-7}, {1.3e5, -2.0e5, 2.5e6, -3.0e6}};
  navigation.klobuchar.push_back({GnssSystem::kBeidou, kSyntheticNoon, own});
  const auto constellation = make_broadcast(navigation_);
  const auto f = file([&](int, GnssEpoch& e) {
    const Horizon horizon(place_);
    for (auto& o : e.observations) {
      const auto s = transmission_to(*constellation, o.sv, e.t, place_);
      const SkyView v = horizon.view(e.t, s->p_E());
      const double hz = carrier_hz(o.sv.system, o.band, s->state.frequency_channel);
      o.pseudorange_m += o.sv.system == GnssSystem::kBeidou
                             ? beidou_klobuchar_delay_m(own, v)
                             : klobuchar_delay_m(kBuiltInKlobuchar, v.t, v.receiver.lat_rad, v.receiver.lon_rad,
                                                 v.azimuth_rad, v.elevation_rad) *
                                   std::pow(kL1Hz / hz, 2);
    }
  });
  auto c = plain();
  c.ionosphere = IonosphereCorrection::kKlobucharOwn;
  c.max_gdop = 100.0;
  for (const char* systems : {"C", "GREC"}) {
    c.systems = systems;
    const auto r = solve_observations(f, {*constellation, navigation}, c);
    ASSERT_TRUE(r.ok()) << r.error().str();
    for (const auto& e : r->epochs) EXPECT_LT((e.fix.p_A_E - place_).norm(), 0.001 * e.fix.dop.pdop) << systems;
  }
}

TEST_F(SyntheticDay, ReasonsAndWarningsWordForWord) {
  // From the second epoch on there are three satellites.
  const auto f = file([](int k, GnssEpoch& e) {
    if (k > 0) e.observations.resize(3);
  });
  auto c = plain();
  c.systems = "G";
  const auto r = solve_file(f, c);
  ASSERT_TRUE(r.ok());
  EXPECT_EQ(r->solved(), 1);
  EXPECT_THAT(r->reasons, ElementsAre(std::pair("3 satellites, a fix needs 4", 39)));
  EXPECT_EQ(r->epochs[5].fix.reason, "3 satellites, a fix needs 4");
  EXPECT_THAT(solution_csv(*r), HasSubstr(",none,0,,,,,,0,,,,,,,,,,,,,,,,,,,,\"3 satellites, a fix needs 4\"\n"));
}

TEST_F(SyntheticDay, NavigationOfAnotherDayIsAnError) {
  auto other = navigation_;
  for (auto& e : other.kepler) {
    e.toe = e.toe + 86400.0;
    e.toc = e.toe;
  }
  other.glonass.clear();
  const auto f = file([](int, GnssEpoch&) {});
  const auto r = solve_observations(f, {*make_broadcast(other), other}, plain());
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().str(),
            "synthetic.rnx:" + std::to_string(f.epochs.front().line) +
                ": no satellite observed from 2020-06-25T12:00:30 to 2020-06-25T12:20:00 has a valid ephemeris in "
                "synthetic, expected navigation files of the same day and systems");
  // One satellite without ephemeris is a counted warning.
  auto less = navigation_;
  const SatelliteId lost = f.epochs.front().satellites.front().sv;
  std::erase_if(less.kepler, [&](const auto& e) { return e.sv == lost; });
  const auto partly = solve_observations(f, {*make_broadcast(less), less}, plain());
  ASSERT_TRUE(partly.ok());
  EXPECT_EQ(partly->solved(), 40);
  ASSERT_EQ(partly->warnings.size(), 1u);
  EXPECT_THAT(partly->warnings[0], HasSubstr(lost.str() + " has no valid healthy ephemeris at 2020-06-25T12:00:30"));
}

TEST_F(SyntheticDay, BadConfigurationsAreErrorsWordForWord) {
  const auto f = file([](int, GnssEpoch&) {});
  auto c = plain();
  c.systems = "GX";
  EXPECT_FALSE(solve_file(f, c).ok());
  c.systems = "J";
  EXPECT_EQ(solve_file(f, c).error().str(),
            "synthetic.rnx: systems: no pseudorange of the systems J in it, expected systems that were observed");
  auto without = navigation_;
  without.klobuchar.clear();
  auto klobuchar = plain();
  klobuchar.ionosphere = IonosphereCorrection::kKlobuchar;
  EXPECT_EQ(solve_observations(f, {*make_broadcast(without), without}, klobuchar).error().str(),
            "synthetic: ionosphere: \"klobuchar\" needs Klobuchar coefficients, and there are none in it, expected a "
            "navigation file with them, or ionosphere = \"none\"");
}

}  // namespace
}  // namespace canyon::gnss
