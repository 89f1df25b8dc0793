#include "canyon/lidar/deskew.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/lidar/scanner.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

using testing::kStart;
using testing::position;

/// Driving at 10 m/s and turning at 40 deg/s past a long wall at y = 15.
class WallSeenWhileTurning : public ::testing::Test {
 protected:
  WallSeenWhileTurning() : scene_(parts()) {
    Vector6d twist;
    twist << 0, 0, 40 * kDegree, 10, 0, 0;
    motion_ = testing::twisting(testing::pose_at(3, 2, 0, 20), twist);
  }
  static scene::SceneParts parts() {
    scene::SceneParts parts = testing::empty_parts();
    testing::add_wall(parts, {-200, 15}, {200, 15}, 60);
    return parts;
  }
  LidarOutput scan(const LidarConfig& config) const {
    return (*make_scanner(config, 9))->scan(0, kStart, motion_, scene::SceneAt(scene_));
  }
  /// Signed distances from the wall, points taken at the pose of the stamp.
  std::vector<double> departures(const LidarScan& scan, const LidarConfig& config) const {
    const Pose X_WL = *motion_.at(kStart) * sensor_in_body(config);
    std::vector<double> out;
    for (const LidarPoint& p : scan.points) out.push_back((X_WL * position(p)).y() - 15.0);
    return out;
  }
  static double rms(const std::vector<double>& values) {
    double squares = 0;
    for (double v : values) squares += v * v;
    return std::sqrt(squares / static_cast<double>(values.size()));
  }

  scene::Scene scene_;
  Trajectory motion_;
};

TEST_F(WallSeenWhileTurning, IsBentBeforeAndFlatAfter) {
  LidarConfig config = testing::ideal_lidar();
  config.mount_m = {0.5, 0.1, 1.8};
  const LidarOutput out = scan(config);
  ASSERT_GT(out.scan.points.size(), 5000u);
  EXPECT_GT(rms(departures(out.scan, config)), 0.5) << "4 deg of turn and 1 m of way within the sweep";
  const LidarScan flat = deskew(out.scan, motion_, sensor_in_body(config));
  ASSERT_EQ(flat.points.size(), out.scan.points.size());
  for (const double d : departures(flat, config)) EXPECT_NEAR(d, 0, 2e-4);  // range 1e-4 m, float coordinates of 100 m
  for (const LidarPoint& p : flat.points) EXPECT_EQ(p.time_s, 0.0f);
  EXPECT_EQ(flat.points[100].ring, out.scan.points[100].ring);
  EXPECT_EQ(flat.points[100].intensity, out.scan.points[100].intensity);
}

TEST_F(WallSeenWhileTurning, IsFlatToTheNoise) {
  LidarConfig config;
  config.range_noise_m = 0.02;
  config.report.range_quantum_m = 0;
  const LidarOutput out = scan(config);
  const LidarScan flat = deskew(out.scan, motion_, sensor_in_body(config));
  const std::vector<double> d = departures(flat, config);
  // A range error shows in the distance from the wall by the cosine of incidence.
  std::vector<double> normalized;
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (out.truth[i].cos_incidence > 0.05f) normalized.push_back(d[i] / out.truth[i].cos_incidence);
  }
  const double n = static_cast<double>(normalized.size());
  ASSERT_GT(n, 5000);
  EXPECT_NEAR(rms(normalized) / 0.02, 1.0, 4.5 / std::sqrt(2 * n) + 2e-4 / 0.02);  // 4.5 sigma: false alarms 7e-6
}

TEST_F(WallSeenWhileTurning, PointsOutsideTheBufferAreDropped) {
  const LidarConfig config = testing::ideal_lidar();
  const LidarOutput out = scan(config);
  Trajectory late;
  for (const StampedPose& pose : motion_.poses()) {
    if (pose.t >= kStart - 0.075) late.append(pose);
  }
  const LidarScan part = deskew(out.scan, late, sensor_in_body(config));
  std::size_t expected = 0;
  for (const LidarPoint& p : out.scan.points) expected += p.time_s >= -0.075 - 1e-8;
  EXPECT_EQ(part.points.size(), expected);
  EXPECT_LT(part.points.size(), out.scan.points.size());
  EXPECT_GT(part.points.size(), 100u);
  // Without the pose at the stamp there is no frame to move the points to.
  Trajectory early;
  early.append({kStart - 0.2, Pose{}});
  early.append({kStart - 0.01, Pose{}});
  EXPECT_TRUE(deskew(out.scan, early, sensor_in_body(config)).points.empty());
}

}  // namespace
}  // namespace canyon::lidar
