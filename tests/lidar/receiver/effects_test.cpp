// What is off in a sensor: bias, jitter, latency, crosstalk, its own vehicle.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/lidar/scanner.h"
#include "canyon/tests/lidar/beam/screens.h"

namespace canyon::lidar {
namespace {

using testing::add_screen;
using testing::ideal_lidar;
using testing::kStart;
using testing::level_laser;
using testing::pose_at;
using testing::position;
using testing::scan_of;
using testing::yaw_deg;

TEST(Effects, CrosstalkIsAsFrequentAsSaid) {
  LidarConfig config = ideal_lidar();
  config.crosstalk.probability = 0.02;
  const LidarOutput out = scan_of(testing::empty_parts(), config);
  const double n = 28800;
  EXPECT_NEAR(static_cast<double>(out.truth.size()) / n, 0.02, 4.5 * std::sqrt(0.02 * 0.98 / n));
  for (const LidarPointTruth& t : out.truth) EXPECT_EQ(t.material, kNoMaterial);
}

TEST(Effects, BiasBelongsToTheLaserAndStays) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {20, -200}, {20, 200}, 60);
  LidarConfig config = ideal_lidar();
  config.report.range_bias_m = 0.03;
  std::map<int, double> bias_m;
  double squares = 0;
  for (const std::int64_t index : {0, 5}) {
    const LidarOutput out = scan_of(parts, config, Pose{}, index);
    const BeamTable table = *load_beam_table("vlp16");
    for (std::size_t i = 0; i < out.truth.size(); ++i) {
      const LidarPoint& p = out.scan.points[i];
      const double error_m =
          (position(p) - Eigen::Vector3d(0, 0, table.beams[p.ring].origin_up_m)).norm() - out.truth[i].range_m;
      const auto [known, fresh] = bias_m.emplace(p.ring, error_m);
      if (fresh) squares += error_m * error_m;
      EXPECT_NEAR(error_m, known->second, 200 * 6 * 6e-8);
    }
  }
  ASSERT_GE(bias_m.size(), 8u);
  // Chi-square of 8 or more lasers: 4.5 sigma either side.
  const auto n = static_cast<double>(bias_m.size());
  EXPECT_NEAR(squares / n, 0.03 * 0.03, 4.5 * 0.03 * 0.03 * std::sqrt(2 / n));
}

TEST(Effects, AngleNoiseMovesTheRayNotTheReport) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {20, -50}, {20, 50}, 60);
  LidarConfig config = level_laser();
  config.angle_noise_deg = 0.1;
  const LidarOutput out = scan_of(parts, config);
  double squares = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const double yaw = yaw_deg(out.scan.points[i]) * kDegree;
    if (std::abs(std::abs(yaw) - 45 * kDegree) > 10 * kDegree) continue;
    // range = 20 / cos(yaw): an error of angle e changes it by range tan(yaw) e.
    const double e = (out.truth[i].range_m * std::cos(yaw) / 20 - 1) / std::tan(yaw);
    squares += e * e, ++n;
  }
  ASSERT_GT(n, 300u);
  const double sigma = 0.1 * kDegree;
  // 4.5 sigma, and second-order terms of 0.2 %.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(n)), sigma,
              4.5 * sigma / std::sqrt(2.0 * static_cast<double>(n)) + 0.005 * sigma);
}

TEST(Effects, LatencyShowsThePast) {
  // At 10 m/s towards a wall, stamps 50 ms late: all ranges are longer by 0.5 m at the stamp's own instant.
  Vector6d twist;
  twist << 0, 0, 0, 10, 0, 0;
  scene::SceneParts parts = testing::empty_parts();
  add_screen(parts, 40, 30, "concrete");
  const scene::Scene scene(parts);
  LidarConfig config = level_laser();
  const auto ranges = [&](double latency_s) {
    config.latency_s = latency_s;
    return (*make_scanner(config, 1))->scan(0, kStart, testing::twisting(Pose{}, twist), scene::SceneAt(scene));
  };
  const LidarOutput prompt = ranges(0), late = ranges(0.05);
  EXPECT_EQ(prompt.scan.t, late.scan.t);
  ASSERT_GT(late.scan.points.size(), 100u);
  for (const LidarPoint& p : late.scan.points) EXPECT_NEAR(p.x, 40 - 10 * (p.time_s - 0.05), 2e-4);
  for (const LidarPoint& p : prompt.scan.points) EXPECT_NEAR(p.x, 40 - 10 * p.time_s, 2e-4);
}

TEST(Effects, TheOwnVehicleIsHidden) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 200);
  LidarConfig config = ideal_lidar();
  config.mount_m = {0.3, 0, 1.8};
  const std::size_t all = scan_of(parts, config).truth.size();
  config.ego.min_m = {-1, -0.9, 0.2}, config.ego.max_m = {3, 0.9, 1.5};
  const LidarOutput out = scan_of(parts, config);
  EXPECT_LT(out.truth.size(), all);
  const BeamTable table = *load_beam_table("vlp16");
  for (const LidarPoint& p : out.scan.points) {
    // The way from the laser to the point never enters the box.
    const Eigen::Vector3d up(0, 0, table.beams[p.ring].origin_up_m);
    const Eigen::Vector3d origin = config.mount_m + up, way = position(p) - up;
    for (int k = 0; k <= 1000; ++k) {
      const Eigen::Vector3d at = origin + way * (k / 1000.0);
      const bool inside =
          ((at - config.ego.min_m).array() > 1e-6).all() && ((config.ego.max_m - at).array() > 1e-6).all();
      ASSERT_FALSE(inside);
    }
  }
}

TEST(Models, SameBitsForAnyNumberOfThreads) {
  const scene::Scene scene(testing::street_crossing());
  Vector6d twist;
  twist << 0, 0, 0.5, 8, 0, 0;
  const Trajectory motion = testing::twisting(pose_at(-10, 1, 0, 10), twist);
  LidarConfig config;
  config.model.name = "footprint";
  config.detector.name = "radiometric";
  config.report.returns = ReturnMode::kDual;
  config.weather.rain_mm_h = 20;
  config.crosstalk.probability = 0.001;
  config.angle_noise_deg = 0.05;
  config.report.range_bias_m = 0.01;
  std::vector<LidarOutput> outputs;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    outputs.push_back((*make_scanner(config, 1))->scan(5, kStart, motion, scene::SceneAt(scene)));
  }
  set_threads(0);
  EXPECT_GT(outputs[0].scan.points.size(), 10000u);
  EXPECT_TRUE(testing::same(outputs[0], outputs[1]));
  EXPECT_TRUE(testing::same(outputs[0], outputs[2]));
}

}  // namespace
}  // namespace canyon::lidar
