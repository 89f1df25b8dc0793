// A base station that is simulated too.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/process/embedded.h"
#include "canyon/gnss/rinex/observation/observation_writer.h"
#include "canyon/gnss/single_point/single_point.h"
#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::gnss {
namespace {

using testing::open_sky;

class BaseReceiverTest : public testing::PseudorangeSensorTest {
 protected:
  /// Of a base of this receiver at the rover's own place, whose epochs are the rover's.
  static GnssConfig with_base(const std::string& receiver) {
    GnssConfig c = open_sky("dgps_base");
    c.satellites.systems = "GR";
    BaseStationParameters& base = base_of(c);
    base.receiver = receiver;
    base.place_m = {0.0, 0.0, 2.0};
    base.rate_hz = 2.0;
    base.latency_s = 0.0;
    return c;
  }
  static BaseStationParameters& base_of(GnssConfig& c) { return c.mode.own.get<BaseStationParameters>(); }
  /// Nothing that base and rover do not share but the distance.
  static void without_own_errors(GnssConfig& c) {
    c.tracking.thermal_noise_scale = c.mode.own.get<DgpsParameters>().base_error_scale = 0.0;
    c.link.antenna_phase_centre = false;
  }
  /// A receiver of the catalogue with another figure, as a file.
  static std::string changed_receiver(const std::string& name, const std::string& key, const std::string& value) {
    std::string text(*embedded_file("gnss/receivers/" + name + ".toml"));
    const std::size_t from = text.find("\n" + key + " = ") + 1, to = text.find('\n', from);
    text.replace(from, to - from, key + " = " + value);
    const std::string path = canyon::testing::temporary_file("changed_" + name + "_" + key + ".toml");
    std::ofstream(path) << text;
    return path;
  }
  double error_m(const GnssOutput& out) const { return (out.fix.p_A_E - truth_E()).norm(); }
};

// Ionosphere, troposphere, orbits and clocks are off by metres, all of it shared. The phone does not smooth: what a
// carrier makes of the ionosphere's change would be the base's own. Ranges round to 1e-8 m, delays of 30 m place a
// satellite 1e-7 s, 0.1 mm in range, off; times a GDOP of 3.
TEST_F(BaseReceiverTest, InTheRoversPlaceItTakesAllAway) {
  GnssConfig c = with_base("phone");
  without_own_errors(c);
  const auto sensor = make(c);
  for (std::int64_t k = 0; k < 20; ++k) {
    const GnssOutput out = measure(*sensor, k);
    ASSERT_EQ(out.fix.status, FixStatus::kDifferential) << out.fix.reason;
    EXPECT_LT(error_m(out), 1e-3);
    EXPECT_EQ(out.fix.satellites, static_cast<int>(out.epoch.observations.size()));
  }
  c.mode.name = "single";
  EXPECT_GT(error_m(measure(*make(c), 0)), 0.5);
}

// What the air between the two differs by is drawn as for mode dgps, of the same streams. On top comes what the models
// themselves see elsewhere: at 5 km a satellite stands by 5e3 / 2e7 rad higher or lower, which changes an ionosphere of
// 5 m and a mapping of less than 10 per rad by 13 mm at most. RMS of 40 seeds of 8 satellites: 5 / sqrt(2 x 320).
TEST_F(BaseReceiverTest, WhatIsLeftGrowsWithTheBaselineAsInModeDgps) {
  GnssConfig c = with_base("phone");
  without_own_errors(c);
  double near2 = 0.0, far2 = 0.0, dgps2 = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto at = [&](const char* mode, double x_m) {
      c.mode.name = mode;
      base_of(c).place_m.x() = x_m;
      return measure(*make(c, seed), 0).truth.satellites;
    };
    const auto near = at("dgps_base", 5e3), far = at("dgps_base", 2e4), dgps = at("dgps", 0.0);
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (near[i].elevation_rad < 0.3) continue;  // those that the base may not see
      EXPECT_NEAR(near[i].ionosphere_m, dgps[i].ionosphere_m, 0.013);
      // Linear but for the curvature of the Earth and of the mapping: a degree of 20 km.
      EXPECT_NEAR(far[i].ionosphere_m, 4.0 * near[i].ionosphere_m, 2e-3 + 0.1 * std::abs(far[i].ionosphere_m));
      EXPECT_NEAR(far[i].troposphere_m, 4.0 * near[i].troposphere_m, 2e-3 + 0.1 * std::abs(far[i].troposphere_m));
      near2 += std::pow(near[i].ionosphere_m, 2), far2 += std::pow(far[i].ionosphere_m, 2);
      dgps2 += std::pow(dgps[i].ionosphere_m, 2);
      ++n;
    }
  }
  ASSERT_GE(n, 320);
  EXPECT_NEAR(std::sqrt(near2 / dgps2), 1.0, 5.0 / std::sqrt(2.0 * 320.0));
  EXPECT_NEAR(std::sqrt(far2 / near2), 4.0, 0.1);
}

TEST_F(BaseReceiverTest, WhatItDoesNotSeeIsNotUsed) {
  GnssConfig c = with_base(changed_receiver("phone", "mask_deg", "25.0"));
  without_own_errors(c);
  c.receiver_clock.name = "none";  // its wandering is noise to a filter
  c.satellites.systems = "GREC";
  for (const Estimator estimator : {Estimator::kLeastSquares, Estimator::kKalman}) {
    c.position.estimator = estimator;
    const auto sensor = make(c);
    for (std::int64_t k = 0; k < 3; ++k) {
      const GnssOutput out = measure(*sensor, k);
      ASSERT_EQ(out.fix.status, FixStatus::kDifferential) << out.fix.reason;
      int used = 0, low = 0;
      for (const GnssObservation& o : out.epoch.observations) {
        const auto truth = std::find_if(out.truth.satellites.begin(), out.truth.satellites.end(),
                                        [&](const GnssObservationTruth& t) { return t.sv == o.sv; });
        const bool seen = truth->elevation_rad > 25.0 * kDegree;
        EXPECT_EQ(o.used, seen) << o.sv.str();
        EXPECT_EQ(std::isfinite(o.sigma_m), seen) << o.sv.str();
        EXPECT_TRUE(o.p_E.allFinite() && o.v_E.allFinite() && std::isfinite(o.corrected_m()));
        used += o.used, low += !seen;
      }
      EXPECT_EQ(out.fix.satellites, used);
      EXPECT_GE(low, 3);
      EXPECT_LT(error_m(out), 1e-3);  // as above; uncorrected satellites are metres off
    }
  }
}

// Epochs of the base every 50 s, the last one 1 s before the start, and each a second under way.
TEST_F(BaseReceiverTest, OldCorrectionsAreNotUsedAndTheFixSaysWhy) {
  GnssConfig c = with_base("phone");
  base_of(c).rate_hz = 0.02;
  base_of(c).latency_s = 1.0;
  for (const Estimator estimator : {Estimator::kLeastSquares, Estimator::kKalman}) {
    c.position.estimator = estimator;
    const auto sensor = make(c);
    for (std::int64_t k = 0; k <= 102; ++k) {
      const GnssOutput out = measure(*sensor, k);
      const double t_s = 0.5 * static_cast<double>(k), age_s = t_s < 50.0 ? t_s + 1.0 : t_s - 49.0;
      char reason[64] = "";
      if (age_s > 30.0) std::snprintf(reason, sizeof reason, "no corrections of the base for %.0f s", age_s);
      ASSERT_EQ(out.fix.status, age_s > 30.0 ? FixStatus::kNone : FixStatus::kDifferential) << t_s;
      EXPECT_EQ(out.fix.reason, reason);
    }
  }
}

// Both clocks drift, by metres per second and independently. Nothing else errs: what is left is how the rover's wanders
// from its drift in half a second, c sqrt(h0 / 2 x 0.5 s) = 0.07 m, 5 sigma, times a gain of 1. With the base's clock
// in the ranges it is tens of metres.
TEST_F(BaseReceiverTest, AFilterHasItsOwnClockInTheRanges) {
  GnssConfig c = with_base("survey_multi");
  without_own_errors(c);
  c.ionosphere.name = c.troposphere.name = c.ephemeris_error.name = "none";
  c.position.estimator = Estimator::kKalman;
  base_of(c).place_m = {-3000.0, 4000.0, 20.0};
  base_of(c).latency_s = 1.0;
  const auto sensor = make(c);
  double first_m = 0.0, last_m = 0.0;
  for (std::int64_t k = 0; k < 120; ++k) {
    const GnssOutput out = measure(*sensor, k);
    ASSERT_EQ(out.fix.status, FixStatus::kDifferential) << out.fix.reason;
    EXPECT_LT(error_m(out), 0.35);
    EXPECT_NEAR(out.fix.clock_m, out.truth.receiver_clock_m, 0.35);
    (k == 0 ? first_m : last_m) = out.truth.receiver_clock_m;
  }
  EXPECT_GT(std::abs(last_m - first_m), 1.0);
}

// An epoch asked alone finds a base that has been running for long. The base's sums hold other ambiguities then, 2e5 m
// of rounding 3e-11 m each.
TEST_F(BaseReceiverTest, AloneOrInSequenceItSendsTheSame) {
  GnssConfig c = with_base("survey_multi");
  base_of(c).rate_hz = 1.0;
  base_of(c).place_m = {-3000.0, 4000.0, 20.0};
  const auto sequence = make(c), alone = make(c);
  std::vector<GnssOutput> first;
  for (std::int64_t k = 0; k < 60; ++k) first.push_back(measure(*sequence, k));
  for (const std::int64_t k : {59, 7, 30}) {
    const GnssOutput one = measure(*alone, k), &other = first[static_cast<std::size_t>(k)];
    ASSERT_EQ(one.epoch.observations.size(), other.epoch.observations.size());
    for (std::size_t i = 0; i < one.epoch.observations.size(); ++i)
      EXPECT_NEAR(one.epoch.observations[i].correction_m, other.epoch.observations[i].correction_m, 1e-6);
    EXPECT_LT((one.fix.p_A_E - other.fix.p_A_E).norm(), 1e-6);
  }
  for (std::int64_t k = 0; k < 60; ++k)
    EXPECT_EQ(measure(*sequence, k).fix.p_A_E, first[static_cast<std::size_t>(k)].fix.p_A_E);
}

// What both receivers wrote down, solved by canyon gnss solve --base: the same corrections, and so the same fixes. Of
// ranges that are rounded to 0.5 mm at both ends, times a gain of 5.
TEST_F(BaseReceiverTest, ItIsSolvedAsRecordingsAre) {
  GnssConfig rover = with_base("phone");
  without_own_errors(rover);
  rover.satellites.systems = "G";
  base_of(rover).place_m = {-3000.0, 4000.0, 20.0};
  auto& gradients = rover.mode.own.get<DgpsParameters>();
  gradients.ionosphere_gradient_mm_per_km = gradients.troposphere_gradient_mm_per_km = 0.0;
  rover.position.weighting.name = "budget";
  GnssConfig base = rover;
  base.mode.name = "single";
  const auto recorded = [&](GnssSensor& sensor, const Eigen::Vector3d& p_W, std::vector<GnssFix>* fixes) {
    ObservationWriter writer({.first = testing::kStart, .bands = {{GnssSystem::kGps, {1}}}});
    std::string text = writer.header();
    for (std::int64_t k = 0; k < 20; ++k) {
      const GnssOutput out =
          sensor.measure(k, testing::kStart + 0.5 * static_cast<double>(k), p_W, still, scene::SceneAt(*scene));
      text += writer.epoch(out.epoch);
      if (fixes != nullptr) fixes->push_back(out.fix);
    }
    return *parse_observation_file(text, "recorded.rnx");
  };
  std::vector<GnssFix> fixes;
  const ObservationFile of_rover = recorded(*make(rover), antenna_W, &fixes);
  const BaseRecording of_base{recorded(*make(base), base_of(rover).place_m, nullptr),
                              scene->frame().to_E(base_of(rover).place_m)};
  SinglePointConfig options;
  options.systems = "G";
  options.ionosphere = IonosphereCorrection::kNone;
  options.smoothing_s = 0.0;
  options.fault_exclusion = "none";
  options.sigma_m = rover.position.solver_sigma_m;
  const NavigationData nothing;
  const auto solved = solve_observations(of_rover, {*make_nominal("G"), nothing, nullptr, &of_base}, options);
  ASSERT_TRUE(solved.ok()) << solved.error().str();
  ASSERT_EQ(solved->epochs.size(), fixes.size());
  for (std::size_t k = 0; k < fixes.size(); ++k) {
    ASSERT_EQ(fixes[k].status, FixStatus::kDifferential) << fixes[k].reason;
    EXPECT_LT((solved->epochs[k].fix.p_A_E - fixes[k].p_A_E).norm(), 0.005);
    EXPECT_NEAR(solved->epochs[k].fix.clock_m, fixes[k].clock_m, 0.005);
  }
}

TEST_F(BaseReceiverTest, MistakesWordForWord) {
  const auto mistake = [this](auto change) {
    GnssConfig c = with_base("phone");
    change(c);
    return error_of(c);
  };
  EXPECT_EQ(mistake([](GnssConfig& c) { base_of(c).receiver = "phon"; }),
            "gnss.base_receiver: no receiver \"phon\" in the catalogue, expected \"phone\"?");
  EXPECT_EQ(mistake([](GnssConfig& c) { base_of(c).receiver = "dgps_2010"; }),
            "gnss.base_receiver: receiver \"dgps_2010\" needs a base itself, mode = \"dgps\", expected a receiver that "
            "stands alone");
  EXPECT_EQ(mistake([](GnssConfig& c) {
              c.satellites.systems = "EC";
              base_of(c).receiver = "m8";
            }),
            "gnss.base_receiver: receiver \"m8\" tracks GR, the rover EC, expected a system that both track");
  const std::string covered =
      " m above the ellipsoid, expected -500 to 20000 m, the heights that the models of the atmosphere cover";
  const std::string high = mistake([](GnssConfig& c) { base_of(c).place_m.z() = 3e4; });
  EXPECT_THAT(high, ::testing::StartsWith("gnss.base_place_m: the antenna would be "));
  EXPECT_THAT(high, ::testing::EndsWith(covered));
  EXPECT_THAT(mistake([](GnssConfig& c) { base_of(c).place_m.z() = -2e3; }),
              ::testing::HasSubstr("m below the ellipsoid"));
  EXPECT_EQ(mistake([](GnssConfig& c) {
              c.position.solver.name = "trilateration";
              c.receiver_clock.name = "none";
            }),
            "gnss.mode, gnss.solver: solver \"trilateration\" has no unknown for what a base's clock leaves in mode "
            "\"dgps_base\", expected gnss.solver = \"least_squares\", or another gnss.mode");
  // Without the mode its keys are not looked at.
  EXPECT_EQ(mistake([](GnssConfig& c) {
              c.mode.name = "dgps";
              base_of(c).receiver = "phon";
            }),
            "no error");
}

}  // namespace
}  // namespace canyon::gnss
