// What a reader keeps of a scan is the same whether or not the rest is followed.
#include "canyon/lidar/kept_room.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/lidar/clearance.h"
#include "canyon/lidar/scanner.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

using testing::kStart;
using testing::pose_at;

/// Ground and four walls.
scene::SceneParts yard(double half_m) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 2 * half_m, 0.0);
  const double h = half_m;
  testing::add_wall(parts, {h, -h}, {h, h}, 30);
  testing::add_wall(parts, {h, h}, {-h, h}, 30);
  testing::add_wall(parts, {-h, h}, {-h, -h}, 30);
  testing::add_wall(parts, {-h, -h}, {h, -h}, 30);
  return parts;
}

LidarConfig vlp16() {
  LidarConfig c;
  c.ego = {};
  return c;
}

/// Points of a scan that a reader keeps, of a body that stood still.
std::vector<LidarPoint> kept(const LidarScan& scan, const LidarConfig& config, const KeptRoom& room, double radius_m) {
  const Pose X_BL = sensor_in_body(config);
  std::vector<LidarPoint> out;
  for (const LidarPoint& point : scan.points) {
    const Eigen::Vector3d p = X_BL * Eigen::Vector3d(point.x, point.y, point.z);
    if (p.z() >= room.low_m && p.z() <= room.high_m && p.head<2>().norm() <= radius_m) out.push_back(point);
  }
  return out;
}

struct Scans {
  LidarOutput full, less;
  std::int64_t full_rays = 0, less_rays = 0;
};
Scans scans(const scene::SceneParts& parts, const LidarConfig& config, const KeptRoom& room) {
  const scene::Scene scene(parts);
  const Trajectory motion = testing::standing(pose_at(3, -2, 0, 20));
  Scans out;
  for (const bool all : {true, false}) {
    const auto scanner = *make_scanner(config, 5);
    scanner->keep(all ? nullptr : &room);
    (all ? out.full : out.less) = scanner->scan(7, kStart, motion, scene::SceneAt(scene));
    (all ? out.full_rays : out.less_rays) = scanner->rays();
  }
  return out;
}

void expect_same(const std::vector<LidarPoint>& a, const std::vector<LidarPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 100u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].x, b[i].x);
    EXPECT_EQ(a[i].y, b[i].y);
    EXPECT_EQ(a[i].z, b[i].z);
    EXPECT_EQ(a[i].time_s, b[i].time_s);
  }
}

TEST(KeptRoom, WhatIsKeptIsTheSameBits) {
  for (const double half_m : {4.0, 9.0, 30.0}) {
    const LidarConfig config = vlp16();
    const KeptRoom room{.low_m = -2.5, .high_m = 2.2, .reach_m = 25.0};
    const Scans s = scans(yard(half_m), config, room);
    expect_same(kept(s.full.scan, config, room, 20.0), kept(s.less.scan, config, room, 20.0));
    EXPECT_LT(s.less.scan.points.size(), s.full.scan.points.size()) << half_m;
  }
}

// Echoes that are lost, that are noisier than others and that read short, of walls with windows.
TEST(KeptRoom, WhatIsKeptOfAThresholdIsTheSameBits) {
  for (const char* walk : {"0.0", "0.02"}) {
    LidarConfig config = vlp16();
    testing::set_keys(config,
                      "detector = \"radiometric\"\nrange_at_10_percent_m = 12\nsaturation = 2\n"
                      "brightness = \"varied\"\nwindows = \"lattice\"\nsaturation_walk_m = " +
                          std::string(walk));
    const KeptRoom room{.low_m = -2.5, .high_m = 2.2, .reach_m = 25.0};
    const Scans s = scans(yard(9.0), config, room);
    expect_same(kept(s.full.scan, config, room, 20.0), kept(s.less.scan, config, room, 20.0));
    EXPECT_LT(s.less.scan.points.size(), s.full.scan.points.size()) << walk;
  }
}

TEST(KeptRoom, WhereNothingStandsShotsUpwardsAreNotFired) {
  const LidarConfig config = vlp16();
  const KeptRoom room{.low_m = -2.5,
                      .high_m = 2.2,
                      .reach_m = 25.0,
                      .turned_rad = 0.001,
                      .moved_m = 0.0,
                      .clear_m = 25.0,
                      .above_ground_m = 1.8,
                      .ground_rise = 0.0};
  const Scans s = scans(yard(40.0), config, room);
  expect_same(kept(s.full.scan, config, room, 20.0), kept(s.less.scan, config, room, 20.0));
  // Of sixteen beams from -15 to 15 degrees eight point up; that of 1 degree may leave the room through its side.
  EXPECT_EQ(s.less_rays * 16, s.full_rays * 9);
}

// A screen at a seeded place, nearer than what is said to be clear, flips what is fired.
TEST(KeptRoom, AThingBesideTheRouteIsSeenByTheClearance) {
  RouteSegment piece;
  piece.points_W = {{-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}};
  piece.half_width_m = 2.0;
  piece.low_m = -0.5;
  piece.high_m = 0.5;
  const scene::Scene empty(yard(100.0));
  const double far_m = clearances(empty, {}, {piece})[0].clear_m;
  EXPECT_EQ(far_m, Clearance::kMost_m);
  for (int k = 0; k < 20; ++k) {
    const double angle = 0.3 * k, away_m = 8.0 + 0.7 * k;
    scene::SceneParts parts = yard(100.0);
    const Eigen::Vector2d at = away_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    testing::add_wall(parts, at, at + Eigen::Vector2d(0.5, 0.0), 3);
    const scene::Scene scene(parts);
    EXPECT_LE(clearances(scene, {}, {piece})[0].clear_m, away_m - 2.0) << k;
    EXPECT_GE(clearances(scene, {}, {piece})[0].clear_m, away_m - 2.0 - 10.0 - 0.5) << k;
    const std::vector<scene::SweptRoom> car{{at, at + Eigen::Vector2d(30.0, 0.0), 2.5, 2.0}};
    EXPECT_LE(clearances(empty, car, {piece})[0].clear_m, std::max(0.0, away_m - 2.0 - 2.5)) << k;
  }
}

TEST(KeptRoom, ShotsThatDependOnMoreAreFollowedToTheEnd) {
  LidarConfig config = vlp16();
  EXPECT_TRUE(follows_shots_alone(config));
  config.detector.name = "radiometric";
  EXPECT_TRUE(follows_shots_alone(config));
  config.weather.rain_mm_h = 5.0;
  EXPECT_FALSE(follows_shots_alone(config));
  const KeptRoom room{.low_m = -2.5, .high_m = 2.2, .reach_m = 25.0};
  const Scans s = scans(yard(20.0), config, room);
  EXPECT_EQ(s.less.scan.points.size(), s.full.scan.points.size());
}

}  // namespace
}  // namespace canyon::lidar
