#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"

namespace canyon::gnss {
namespace {

using testing::errors_off;
using ::testing::HasSubstr;
using testing::kStart;
using testing::open_sky;
using testing::PseudorangeSensorTest;
using testing::WallScene;

TEST_F(PseudorangeSensorTest, ModesLeaveWhatTheySay) {
  const GnssOutput raw = measure(*make(open_sky("single_uncorrected")), 3),
                   single = measure(*make(open_sky("single")), 3), dgps = measure(*make(open_sky("dgps")), 3),
                   paper = measure(*make(open_sky("dgps_paper")), 3);
  ASSERT_GE(raw.truth.satellites.size(), 5u);
  for (std::size_t i = 0; i < raw.truth.satellites.size(); ++i) {
    const auto &r = raw.truth.satellites[i], &s = single.truth.satellites[i], &d = dgps.truth.satellites[i],
               &p = paper.truth.satellites[i];
    EXPECT_GT(r.ionosphere_m, 1.9);
    EXPECT_GT(r.troposphere_m, 2.4);
    EXPECT_DOUBLE_EQ(s.ionosphere_m, 0.5 * r.ionosphere_m);
    EXPECT_LT(std::abs(s.troposphere_m), 0.1 * r.troposphere_m);
    EXPECT_EQ(s.ephemeris_m, r.ephemeris_m);
    // 5 km of baseline: 2 mm/km x 5 km x obliquity 3 x 4 sigma; orbit x 5 km / 20,000 km.
    EXPECT_LT(std::abs(d.ionosphere_m), 4 * 0.010 * 3.1);
    EXPECT_LT(std::abs(d.troposphere_m), 4 * 0.005 * 6.0);
    EXPECT_NEAR(d.ephemeris_m, r.ephemeris_m * 5e3 / r.range_m, 1e-9);
    EXPECT_NE(d.ionosphere_m, 0.0);
    EXPECT_EQ(d.noise_m, r.noise_m);
    EXPECT_NE(d.base_m, 0.0);  // the base's own error comes with its correction
    EXPECT_EQ(p.ionosphere_m, 0.0);
    EXPECT_EQ(p.ephemeris_m, 0.0);
    EXPECT_EQ(p.troposphere_m, r.troposphere_m);
  }
  EXPECT_EQ(raw.fix.status, FixStatus::kSingle);
  EXPECT_EQ(dgps.fix.status, FixStatus::kDifferential);
  EXPECT_EQ(paper.fix.status, FixStatus::kDifferential);
}

TEST_F(PseudorangeSensorTest, DgpsResidualsGrowWithTheBaseline) {
  GnssConfig c = open_sky("dgps");
  c.mode.own.get<DgpsParameters>().base_error_scale = 0.0;
  c.tracking.thermal_noise_scale = 0.0;
  const auto error_at = [&](double baseline_km) {
    c.mode.own.get<DgpsParameters>().baseline_km = baseline_km;
    const auto sensor = make(c);
    return (measure(*sensor, 1).fix.p_A_E - truth_E()).norm();
  };
  EXPECT_LT(error_at(0.0), 1e-4);
  const double near_m = error_at(5.0);
  EXPECT_GT(near_m, 1e-3);
  EXPECT_NEAR(error_at(50.0), 10.0 * near_m, 1e-2 * 10.0 * near_m);  // linear, but for the curvature of the ranges
}

TEST(GnssConfig, ModesSayWhetherTheyCorrectTheAtmosphere) {
  for (const auto& row : receiver_modes()) {
    const auto mode = *ModelChoice<receiver_modes>(row.name).make("gnss.mode", ReceiverModeSetup{});
    EXPECT_THAT(row.doc, HasSubstr(mode->corrects_atmosphere() ? "residual atmosphere" : "raw atmosphere")) << row.name;
  }
}

// The receiver's own filter: quieter than epochs by themselves, the same bits when measured again, and fixes where the
// epoch alone has none.
TEST_F(PseudorangeSensorTest, AFilteringReceiverIsQuieterAndBridges) {
  GnssConfig c = errors_off();
  c.tracking.thermal_noise_scale = 1.0;
  c.tracking.code_loop_hz = 5.0;  // independent from epoch to epoch, 2 m
  c.position.solver_sigma_m = 2.0;
  const auto rms = [&](GnssSensor& sensor) {
    double square = 0.0;
    for (std::int64_t k = 0; k < 120; ++k) {
      const GnssOutput out = measure(sensor, k);
      EXPECT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
      if (k >= 20) square += (out.fix.p_A_E - truth_E()).squaredNorm();
    }
    return std::sqrt(square / 100.0);
  };
  const auto plain = make(c);
  c.position.estimator = Estimator::kKalman;
  c.position.estimator_acceleration_m_s2 = 0.05;
  const auto filtered = make(c);
  const double filtered_m = rms(*filtered);
  EXPECT_LT(filtered_m, 0.7 * rms(*plain));
  EXPECT_EQ(rms(*filtered), filtered_m);  // index 0 does not follow 119: switched on anew

  // A shaft closes around the antenna: of all satellites a few near the zenith are left.
  c.propagation.paths.name = "visibility";
  const auto shaft = WallScene()
                         .box({-20, -20, 0}, {-6, 20, 12})
                         .box({6, -20, 0}, {20, 20, 12})
                         .box({-6, -20, 0}, {6, -6, 12})
                         .box({-6, 6, 0}, {6, 20, 12})
                         .build();
  const auto sensor = make(c);
  for (std::int64_t k = 0; k < 10; ++k) measure(*sensor, k);
  c.position.estimator = Estimator::kLeastSquares;
  const GnssOutput alone = make(c)->measure(10, kStart + 5.0, antenna_W, still, scene::SceneAt(*shaft));
  const GnssOutput bridged = sensor->measure(10, kStart + 5.0, antenna_W, still, scene::SceneAt(*shaft));
  ASSERT_GT(alone.epoch.observations.size(), 0u);
  ASSERT_LT(alone.epoch.observations.size(), 4u);
  EXPECT_EQ(alone.fix.status, FixStatus::kNone);
  ASSERT_EQ(bridged.fix.status, FixStatus::kSingle) << bridged.fix.reason;
  EXPECT_EQ(bridged.fix.satellites, static_cast<int>(bridged.epoch.observations.size()));
  // As good as it says: chi-square of three degrees, exceeded once in 10,000 times.
  const Eigen::Vector3d error = bridged.fix.p_A_E - truth_E();
  EXPECT_LT(error.dot(bridged.fix.covariance_E.ldlt().solve(error)), chi_square_threshold(1e-4, 3));
}

// 2026-11-22: a satellite whose second signal was lost was dropped as a whole.
TEST_F(PseudorangeSensorTest, ASatelliteWhoseSecondSignalIsLostStays) {
  GnssConfig c = open_sky("single");
  c.propagation.paths.name = "specular1";
  c.propagation.diffraction.name = "knife_edge";
  c.reception.multipath_rule.name = "correlator";
  c.locks.tracking_threshold_dbhz = 28.0;
  c.tracking.thermal_noise_scale = 0.0;
  c.receiver_clock.name = "none";
  const auto single = make(c);
  c.mode.name = "dual";
  const auto dual = make(c);
  int lost = 0, used = 0;
  for (std::int64_t k = 0; k < 900; ++k) {
    const GpsTime t = kStart + 30.0 * static_cast<double>(k);
    const auto look = [&](GnssSensor& sensor) {
      return sensor.measure(1000 * k, t, antenna_W, still, scene::SceneAt(*scene));
    };
    const GnssOutput one = look(*single), two = look(*dual);
    // The first signals are the same ones.
    ASSERT_EQ(one.epoch.observations.size(), two.epoch.observations.size()) << k;
    for (std::size_t i = 0; i < two.epoch.observations.size(); ++i) {
      const GnssObservation &a = one.epoch.observations[i], &b = two.epoch.observations[i];
      EXPECT_EQ(a.sv, b.sv);
      EXPECT_EQ(a.pseudorange_m, b.pseudorange_m);
      if (b.second.band != 0) continue;
      ++lost;
      used += b.used ? 1 : 0;
      EXPECT_TRUE(std::isnan(b.second.pseudorange_m));
      // Its ionosphere is modelled as with one frequency, and what the model leaves is in its sigma.
      const auto& truth = *std::find_if(two.truth.satellites.begin(), two.truth.satellites.end(),
                                        [&](const auto& s) { return s.sv == b.sv; });
      EXPECT_NEAR(truth.ionosphere_m, 0.5 * truth.ionosphere_delay_m, 1e-9);
      EXPECT_GT(b.sigma_m, 0.5 * truth.ionosphere_delay_m);
      // The truth record still accounts for the corrected range; light times to 1e-5 m.
      EXPECT_NEAR(b.corrected_m(),
                  truth.range_m + truth.multipath_m + truth.ionosphere_m + truth.troposphere_m + truth.ephemeris_m +
                      truth.noise_m + truth.base_m + truth.phase_centre_m,
                  1e-4)
          << b.sv.str();
    }
  }
  EXPECT_GT(lost, 20);
  EXPECT_GT(used, 10);
}

TEST_F(PseudorangeSensorTest, AFilterNeedsAReceiverClock) {
  GnssConfig c;
  c.position.estimator = Estimator::kKalman;
  c.position.solver.name = "trilateration";
  c.receiver_clock.name = "none";
  EXPECT_EQ(error_of(c),
            "gnss.estimator, gnss.solver: estimator \"kalman\" needs a receiver clock, which solver \"trilateration\" "
            "does not have, expected gnss.solver = \"least_squares\", or another gnss.estimator");
}

}  // namespace
}  // namespace canyon::gnss
