#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"
#include "canyon/tests/gnss/sensor/gnss_keys.h"

namespace canyon::gnss {
namespace {

using testing::WallScene;

const GpsTime kLowStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

std::unique_ptr<GnssSensor> make(const GnssConfig& c, const scene::Scene& scene) {
  auto sensor = make_gnss_sensor(c, 1, kLowStart, kLowStart + 3600.0, scene);
  EXPECT_TRUE(sensor.ok()) << sensor.error().str();
  return *std::move(sensor);
}

/// Errors of n fixes in east, north, up.
std::vector<Eigen::Vector3d> errors(GnssSensor& sensor, const scene::Scene& scene, const Eigen::Vector3d& p_W, int n) {
  std::vector<Eigen::Vector3d> out;
  for (int k = 0; k < n; ++k) {
    const GnssOutput o = sensor.measure(k, kLowStart + 0.5 * k, p_W, Eigen::Vector3d::Zero(), scene::SceneAt(scene));
    if (o.fix.status != FixStatus::kNone)
      out.push_back(scene.frame().R_EW().transpose() * (o.fix.p_A_E - o.truth.p_A_E));
  }
  return out;
}

// N = 4000 independent fixes: mean within 5 sigma / sqrt(N), mean square within 5 sqrt(2 / N).
TEST(WhiteNoiseSensor, HasItsSigmas) {
  const auto scene = WallScene().box({-60, -300, 0}, {-12, 300, 30}).build();
  GnssConfig c;
  c.model.name = "truth_plus_white";
  const auto sensor = make(c, *scene);
  constexpr int kN = 4000;
  const auto e = errors(*sensor, *scene, {0, 0, 2}, kN);
  ASSERT_EQ(e.size(), static_cast<std::size_t>(kN));
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), square = Eigen::Vector3d::Zero();
  for (const auto& x : e) {
    mean += x / kN;
    square += x.cwiseAbs2() / kN;
  }
  const Eigen::Vector3d sigma(1.0, 1.0, 2.0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(mean[i], 0.0, 5.0 * sigma[i] / std::sqrt(kN));
    EXPECT_NEAR(square[i], sigma[i] * sigma[i], 5.0 * std::sqrt(2.0 / kN) * sigma[i] * sigma[i]);
  }
  const GnssOutput one = sensor->measure(7, kLowStart, {0, 0, 2}, {1, 2, 3}, scene::SceneAt(*scene));
  const Eigen::Matrix3d covariance_W = scene->frame().R_EW().transpose() * one.fix.covariance_E * scene->frame().R_EW();
  EXPECT_NEAR(covariance_W(2, 2), 4.0, 1e-12);
  EXPECT_NEAR(covariance_W(0, 1), 0.0, 1e-12);
  EXPECT_TRUE(one.truth.satellites.empty());
  EXPECT_TRUE(one.epoch.observations.empty());
}

// 2026-11-28: a run with white_sigma_up_m = 0 ended in the filter's own check of what it is given.
TEST(WhiteNoiseSensor, AFixWithoutNoiseStillHasACovarianceToWeighItBy) {
  const auto open = WallScene().wall({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).build();
  for (const auto& [model, keys] : {std::pair{"truth_plus_white", "white_sigma_m = 10000.0\nwhite_sigma_up_m = 0.0"},
                                    std::pair{"truth_plus_white", "white_sigma_m = 0.0\nwhite_sigma_up_m = 0.0"},
                                    std::pair{"satellite_count", "count_noise_max_m = 0.0\ncount_noise_min_m = 0.0"}}) {
    GnssConfig c;
    c.model.name = model;
    testing::set_keys(c, keys);
    const GnssOutput o =
        make(c, *open)->measure(0, kLowStart, {5, 5, 2}, Eigen::Vector3d::Zero(), scene::SceneAt(*open));
    ASSERT_NE(o.fix.status, FixStatus::kNone);
    EXPECT_EQ(o.fix.covariance_E.llt().info(), Eigen::Success) << model << ": " << keys;
  }
}

TEST(SatelliteCountSensor, NoiseFallsWithTheNumberInSight) {
  const auto open = WallScene().wall({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).build();
  GnssConfig c;
  c.model.name = "satellite_count";
  c.mask_deg = 5.0;
  testing::set_keys(c, "count_noise_max_m = 12.0\ncount_noise_min_m = 4.0");
  const auto sensor = make(c, *open);
  for (int k = 0; k < 200; k += 20) {
    const GnssOutput o =
        sensor->measure(k, kLowStart + 17.0 * k, {5, 5, 2}, Eigen::Vector3d::Zero(), scene::SceneAt(*open));
    const int n = o.fix.satellites;
    ASSERT_GE(n, 4);
    EXPECT_EQ(static_cast<std::size_t>(n), o.truth.satellites.size());
    const double sigma_m = (12.0 - std::min(n - 4, 8)) / 3.0;  // 12 m at four, 4 m at twelve, three sigmas each
    EXPECT_NEAR(std::sqrt(o.fix.covariance_E(0, 0)), sigma_m, 1e-12);
    Eigen::MatrixXd H(n, 4);
    for (int i = 0; i < n; ++i) {
      const auto& s = o.truth.satellites[static_cast<std::size_t>(i)];
      const double level = std::cos(s.elevation_rad);
      H.row(i) << level * std::sin(s.azimuth_rad), level * std::cos(s.azimuth_rad), std::sin(s.elevation_rad), 1.0;
    }
    EXPECT_NEAR(o.fix.dop.gdop, std::sqrt((H.transpose() * H).inverse().trace()), 1e-9);
  }
  constexpr int kN = 4000;
  double square = 0.0, claimed = 0.0;
  for (int k = 0; k < kN; ++k) {
    const GnssOutput o = sensor->measure(k, kLowStart, {5, 5, 2}, Eigen::Vector3d::Zero(), scene::SceneAt(*open));
    square += (o.fix.p_A_E - o.truth.p_A_E).squaredNorm() / (3.0 * kN);
    claimed = o.fix.covariance_E(0, 0);
  }
  EXPECT_NEAR(square, claimed, 5.0 * std::sqrt(2.0 / (3.0 * kN)) * claimed);
}

TEST(SatelliteCountSensor, BlockedSkyIsNoFix) {
  const auto street = WallScene().box({-60, -300, 0}, {-3, 300, 60}).box({3, -300, 0}, {60, 300, 60}).build();
  GnssConfig c;
  c.model.name = "satellite_count";
  const auto sensor = make(c, *street);
  bool none = false;
  for (int k = 0; k < 400 && !none; ++k) {
    const GnssOutput o =
        sensor->measure(k, kLowStart + 9.0 * k, {0, 0, 2}, Eigen::Vector3d::Zero(), scene::SceneAt(*street));
    int seen = 0;
    for (const auto& s : o.truth.satellites) seen += s.line_of_sight ? 1 : 0;
    if (seen >= 4) continue;
    none = true;
    EXPECT_EQ(o.fix.status, FixStatus::kNone);
    EXPECT_EQ(o.fix.reason, std::to_string(seen) + (seen == 1 ? " satellite" : " satellites") + ", a fix needs 4");
  }
  EXPECT_TRUE(none);
  testing::set_keys(c, "count_noise_min_m = 20.0");
  const auto wrong = make_gnss_sensor(c, 1, kLowStart, kLowStart, *street);
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().str(), "gnss.count_noise_max_m: is 10, expected at least gnss.count_noise_min_m = 20");
}

}  // namespace
}  // namespace canyon::gnss
