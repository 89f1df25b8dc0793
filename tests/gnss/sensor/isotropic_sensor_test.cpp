#include <cmath>

#include <gtest/gtest.h>

#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"
#include "canyon/tests/gnss/sensor/gnss_keys.h"

namespace canyon::gnss {
namespace {

const GpsTime kIsotropicStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

class IsotropicSensorTest : public ::testing::Test {
 protected:
  IsotropicSensorTest() { config.model.name = "truth_plus_isotropic"; }

  std::unique_ptr<GnssSensor> make(std::uint64_t seed = 1) {
    auto sensor = make_gnss_sensor(config, seed, kIsotropicStart, kIsotropicStart + 60.0, *scene);
    EXPECT_TRUE(sensor.ok()) << sensor.error().str();
    return *std::move(sensor);
  }

  GnssConfig config;
  std::unique_ptr<scene::Scene> scene = testing::WallScene().box({-10, -10, 0}, {10, 10, 5}).build();
  scene::SceneAt at{*scene};
  Eigen::Vector3d antenna_W{100, 50, 3}, still = Eigen::Vector3d::Zero();
};

// N = 3000 fixes. Direction uniform: each component's mean is 0 with sigma |e|/sqrt(3 N); mean square of the length is
// that of U(0.3, 0.5), 0.16333, sigma of l^2 0.0463. 5 sigma.
TEST_F(IsotropicSensorTest, ErrorIsIsotropicWithUniformLength) {
  const auto sensor = make();
  const Eigen::Vector3d truth_E = scene->frame().to_E(antenna_W);
  constexpr int kN = 3000;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double square = 0.0;
  for (int k = 0; k < kN; ++k) {
    const GnssOutput out = sensor->measure(k, kIsotropicStart + 0.5 * k, antenna_W, still, at);
    const Eigen::Vector3d e = out.fix.p_A_E - truth_E;
    EXPECT_GE(e.norm(), 0.3 - 1e-8);
    EXPECT_LE(e.norm(), 0.5 + 1e-8);
    mean += e / kN;
    second += e * e.transpose() / kN;
    square += e.squaredNorm() / kN;
  }
  const double mean_square = (0.5 * 0.5 * 0.5 - 0.3 * 0.3 * 0.3) / (3.0 * 0.2);
  EXPECT_NEAR(square, mean_square, 5.0 * 0.0463 / std::sqrt(kN));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(mean[i], 0.0, 5.0 * std::sqrt(mean_square / 3.0 / kN));
    // Claimed: 0.23^2 per axis, the mean square over three to two digits; sigma of x^2 is at most 0.9 of its mean.
    EXPECT_NEAR(second(i, i), mean_square / 3.0, 5.0 * 0.9 * mean_square / 3.0 / std::sqrt(kN));
  }
  EXPECT_NEAR(std::sqrt(mean_square / 3.0), 0.23, 0.005);
}

TEST_F(IsotropicSensorTest, WhatTheFixSays) {
  const GnssOutput out = make()->measure(4, kIsotropicStart + 2.0, antenna_W, still, at);
  EXPECT_EQ(out.fix.status, FixStatus::kDifferential);
  EXPECT_EQ(out.fix.t, kIsotropicStart + 2.0);
  EXPECT_EQ(out.fix.satellites, 0);
  EXPECT_TRUE(std::isnan(out.fix.dop.gdop));
  EXPECT_TRUE(std::isnan(out.fix.v_A_E.x()));
  EXPECT_EQ(out.fix.covariance_E, (0.23 * 0.23 * Eigen::Matrix3d::Identity()).eval());
  EXPECT_TRUE(out.epoch.observations.empty());
  EXPECT_TRUE(out.truth.satellites.empty());
  EXPECT_EQ(out.truth.p_A_E, scene->frame().to_E(antenna_W));
}

TEST_F(IsotropicSensorTest, DependsOnSeedAndIndexOnly) {
  const auto a = make(), b = make(), c = make(2);
  const Eigen::Vector3d p = a->measure(10, kIsotropicStart + 5.0, antenna_W, still, at).fix.p_A_E;
  b->measure(3, kIsotropicStart, antenna_W, still, at);
  EXPECT_EQ(b->measure(10, kIsotropicStart + 7.0, antenna_W, still, at).fix.p_A_E, p);
  EXPECT_NE(c->measure(10, kIsotropicStart + 5.0, antenna_W, still, at).fix.p_A_E, p);
  EXPECT_NE(a->measure(11, kIsotropicStart + 5.5, antenna_W, still, at).fix.p_A_E, p);
  EXPECT_EQ(a->counters().epochs, 2);
}

TEST_F(IsotropicSensorTest, MaximumBelowMinimumIsAnError) {
  testing::set_keys(config, "isotropic_max_m = 0.2");
  const auto sensor = make_gnss_sensor(config, 1, kIsotropicStart, kIsotropicStart, *scene);
  ASSERT_FALSE(sensor.ok());
  EXPECT_EQ(
      sensor.error().str(),
      "gnss.isotropic_max_m: is 0.20000000000000001, expected at least gnss.isotropic_min_m = 0.29999999999999999");
}

}  // namespace
}  // namespace canyon::gnss
