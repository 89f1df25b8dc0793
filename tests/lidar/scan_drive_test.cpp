#include "canyon/lidar/scan_drive.h"

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

/// A box of walls, 40 m wide, driven through at 5 m/s and turning.
ScanDrive drive() {
  ScanDrive out;
  out.lidar.azimuth_steps = 90;
  out.lidar.model.name = "single_ray";
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 20.0);
  testing::add_wall(parts, {-20, -20}, {20, -20}, 8.0);
  testing::add_wall(parts, {20, -20}, {20, 20}, 8.0);
  testing::add_wall(parts, {20, 20}, {-20, 20}, 8.0);
  testing::add_wall(parts, {-20, 20}, {-20, -20}, 8.0);
  out.scene = std::make_shared<const scene::Scene>(std::move(parts));
  std::vector<StampedPose> poses;
  for (int k = 0; k <= 20; ++k)
    poses.push_back({GpsTime{} + 0.1 * k, {rotation_from({.yaw_rad = 0.05 * k}), {0.5 * k - 5.0, 0.0, 0.5}}});
  out.motion = Trajectory(std::move(poses));
  out.cover_motion();
  return out;
}

TEST(ScanDrive, CoversTheMotion) {
  const ScanDrive d = drive();
  EXPECT_GE(d.start - d.before_s(), d.motion.poses().front().t);
  const GpsTime last = d.start + static_cast<double>(d.scans - 1) * d.period_s();
  EXPECT_LE(last, d.motion.poses().back().t);
  EXPECT_GT(last + d.period_s(), d.motion.poses().back().t);
  // One pose alone ends more than a period before the first stamp.
  for (const std::size_t poses : {1u, 2u}) {
    ScanDrive tiny = d;
    tiny.motion = Trajectory({d.motion.poses().begin(), d.motion.poses().begin() + static_cast<std::ptrdiff_t>(poses)});
    tiny.cover_motion();
    EXPECT_EQ(tiny.scans, 0) << poses;
  }
  ScanDrive none = d;
  none.motion = Trajectory();
  EXPECT_THROW(none.cover_motion(), ProgramError);
}

TEST(ScanDrive, RefusesScansThatTheMotionDoesNotCover) {
  const auto take = [](std::int64_t, GpsTime, const LidarOutput&, const scene::SceneAt&) { return Status(Ok{}); };
  ScanDrive more = drive();
  ++more.scans;
  EXPECT_THROW((void)scan_drive(more, 3, take), ProgramError);
  ScanDrive early = drive();
  early.start = early.start - 0.1;
  EXPECT_THROW((void)scan_drive(early, 3, take), ProgramError);
}

// A point in the scene lies on a surface of it, ground or wall, but for the range noise of 2 cm: 15 cm are more than
// seven sigmas, whatever the angle at which it is met.
TEST(ScanDrive, PointsInTheSceneLieOnItsSurfaces) {
  const ScanDrive d = drive();
  std::int64_t scans = 0, points = 0;
  const auto cost = scan_drive(d, 3, [&](std::int64_t k, GpsTime t, const LidarOutput& output, const scene::SceneAt&) {
    EXPECT_EQ(k, scans++);
    EXPECT_EQ(t, d.start + static_cast<double>(k) * d.period_s());
    for (const LidarPoint& p : points_in_scene(d, output.scan)) {
      const double off_m = std::min(
          {std::abs(double{p.z}), std::abs(20.0 - std::abs(double{p.x})), std::abs(20.0 - std::abs(double{p.y}))});
      EXPECT_LT(off_m, 0.15);
      ++points;
    }
    return Status(Ok{});
  });
  ASSERT_TRUE(cost.ok());
  EXPECT_EQ(scans, d.scans);
  EXPECT_EQ(points, cost->points);
  EXPECT_GT(points, 1000 * d.scans / 2);
  EXPECT_GT(cost->rays, 0);
}

TEST(ScanDrive, WhatTakesAScanMayRefuseIt) {
  const auto cost = scan_drive(drive(), 3, [](std::int64_t, GpsTime, const LidarOutput&, const scene::SceneAt&) {
    return Status(Error{"disk", 0, "", "full", "room"});
  });
  ASSERT_FALSE(cost.ok());
  EXPECT_EQ(cost.error().file, "disk");
}

}  // namespace
}  // namespace canyon::lidar
