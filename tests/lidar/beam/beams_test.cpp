// The built-in sensors in rooms, and scenes at the limits.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "canyon/lidar/beam/beam_table.h"
#include "canyon/tests/lidar/beam/screens.h"

namespace canyon::lidar {
namespace {

using testing::ideal_lidar;
using testing::pose_at;
using testing::position;
using testing::scan_of;
using testing::yaw_deg;

TEST(Beams, RangesToASphere) {
  constexpr int kAround = 4096, kUp = 256;
  constexpr double kRadius_m = 2.0;
  const Eigen::Vector3d center(15, 4, 1);
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ball", scene::ObjectKind::kOther);
  const auto corner = [&](int i, int j) -> Eigen::Vector3d {
    const double azimuth = 2 * kPi * i / kAround, up = -0.2 + 0.4 * j / kUp;  // a band about its equator
    return center + kRadius_m * Eigen::Vector3d(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth),
                                                std::sin(up));
  };
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j < kUp; ++j) mesh.quad(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1), 0);
  // A chord of angle a lies at most r a^2 / 8 inside: 2 pi / 4096 and 0.4 / 256 together, 1.2 um.
  const double sag_m = kRadius_m * (std::pow(2 * kPi / kAround, 2) + std::pow(0.4 / kUp, 2)) / 8;
  ASSERT_LT(sag_m, 2e-6);
  LidarConfig config = ideal_lidar();
  config.beams = "grid:24:0:6";
  config.azimuth_steps = 9000;
  const LidarOutput out = scan_of(parts, config);
  const BeamTable table = *load_beam_table("grid:24:0:6");
  std::size_t compared = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    if (out.truth[i].cos_incidence < 0.2) continue;
    // The nominal direction, from ring and time as a driver would compute it.
    const LidarPoint& p = out.scan.points[i];
    const double elevation = table.beams[p.ring].elevation_rad;
    const auto cycle = std::lround((p.time_s + 0.1) / (0.1 / 9000) - 1);
    const double yaw = kPi - 2 * kPi * static_cast<double>(cycle) / 9000;
    const Eigen::Vector3d d(std::cos(elevation) * std::cos(yaw), std::cos(elevation) * std::sin(yaw),
                            std::sin(elevation));
    const double b = d.dot(center);
    const double expected = b - std::sqrt(b * b - center.squaredNorm() + kRadius_m * kRadius_m);
    if (std::abs(expected * d.z() - center.z()) > 0.95 * kRadius_m * std::sin(0.2))
      continue;  // above or below the band
    ASSERT_NEAR(out.truth[i].range_m, expected, 1e-4) << i;
    ++compared;
  }
  EXPECT_GT(compared, 2000u);
}

TEST(Beams, EveryBuiltInSensorScansARoom) {
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("room", scene::ObjectKind::kBuilding);
  mesh.box({0, 0, 0}, Eigen::Matrix3d::Identity(), {20, 15, 8}, 0);
  for (const std::string& name : builtin_beam_tables()) {
    LidarConfig config = ideal_lidar();
    config.beams = name;
    const BeamTable table = *load_beam_table(name);
    config.azimuth_steps = table.cycle_s > 0 ? 0 : 1024;
    const LidarOutput out = scan_of(parts, config);
    ASSERT_GT(out.truth.size(), 10'000u) << name;
    for (std::size_t i = 0; i < out.truth.size(); ++i) {
      const Eigen::Vector3d p = position(out.scan.points[i]);
      // On a wall, the floor or the ceiling.
      const double off =
          std::min({std::abs(std::abs(p.x()) - 20), std::abs(std::abs(p.y()) - 15), std::abs(std::abs(p.z()) - 8)});
      ASSERT_LT(off, 1e-4) << name << " " << p.transpose();
    }
  }
}

TEST(Beams, ARosetteFillsItsFieldOfViewMoreAndMore) {
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("room", scene::ObjectKind::kBuilding);
  mesh.box({0, 0, 0}, Eigen::Matrix3d::Identity(), {20, 20, 20}, 0);
  LidarConfig config = ideal_lidar();
  config.beams = "mid360";
  config.azimuth_steps = 0;
  std::map<std::pair<int, int>, int> cells;  // 1 deg x 1 deg
  std::vector<std::size_t> filled;
  double low = 90, high = -90;
  for (std::int64_t index = 0; index < 10; ++index) {
    const LidarOutput out = scan_of(parts, config, Pose{}, index);
    EXPECT_NEAR(static_cast<double>(out.scan.points.size()), 20'000, 4.0) << "200,000 points per second";
    for (const LidarPoint& p : out.scan.points) {
      const double elevation = std::asin(p.z / position(p).norm()) / kDegree;
      low = std::min(low, elevation), high = std::max(high, elevation);
      ++cells[{static_cast<int>(std::floor(yaw_deg(p))), static_cast<int>(std::floor(elevation))}];
    }
    filled.push_back(cells.size());
  }
  EXPECT_NEAR(low, -7, 0.01);
  EXPECT_NEAR(high, 52, 0.01);
  EXPECT_GT(filled[9], filled[0] * 3 / 2) << "new places in every frame";
  EXPECT_GT(filled[9], 360u * 59 * 9 / 10);
}

TEST(Extremes, DefinedResults) {
  const auto all_finite = [](const LidarOutput& out) {
    return std::all_of(out.scan.points.begin(), out.scan.points.end(), [](const LidarPoint& p) {
      return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.intensity);
    });
  };
  for (const char* model : {"single_ray", "footprint"}) {
    LidarConfig config = ideal_lidar();
    config.model.name = model;
    config.detector.name = "radiometric";
    config.weather.rain_mm_h = 10;
    // Inside a wall: a closed box of 10 cm around the sensor; everything is nearer than min_range_m.
    scene::SceneParts inside = testing::empty_parts();
    testing::add_box(inside, {0, 0, 0}, {0.05, 0.05, 0.05}, 0);
    EXPECT_TRUE(scan_of(inside, config).scan.points.empty()) << model;
    // In the plane of a wall, exactly.
    scene::SceneParts within = testing::empty_parts();
    testing::add_wall(within, {-10, 0}, {10, 0}, 10);
    EXPECT_TRUE(all_finite(scan_of(within, config))) << model;
    // Nothing at all.
    LidarConfig clear = config;
    clear.weather = {};
    EXPECT_TRUE(scan_of(testing::empty_parts(), clear).scan.points.empty()) << model;
  }
  // Grazing at 89.99 deg: a level floor 1 cm below a beam that is 0.01 deg down, met 57.3 m away.
  scene::SceneParts floor = testing::empty_parts();
  testing::add_ground(floor, 200, -0.01);
  LidarConfig grazing = ideal_lidar();
  grazing.beams = "grid:1:-0.01:-0.01";
  const LidarOutput out = scan_of(floor, grazing);
  ASSERT_EQ(out.truth.size(), 1800u);
  for (const LidarPointTruth& t : out.truth) {
    // A direction in floats is off by 6e-8 or so, which the slope of 1.7e-4 makes 57 m * 3.4e-4.
    EXPECT_NEAR(t.range_m, 0.01 / std::sin(0.01 * kDegree), 57.3 * 4 * 6e-8 / std::sin(0.01 * kDegree));
    EXPECT_NEAR(t.cos_incidence, std::sin(0.01 * kDegree), 4e-7);
  }
}

TEST(Extremes, FiveKilometresFromTheOrigin) {
  // Single precision resolves 0.5 mm at 5 km: the origin of the rays and the corners of the wall are rounded to half of
  // that each.
  const double far_m = 5000.3;
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {far_m + 20, -100}, {far_m + 20, 100}, 60);
  LidarConfig config = ideal_lidar();
  const LidarOutput out = scan_of(parts, config, pose_at(far_m, 0, 2, 0));
  ASSERT_GT(out.truth.size(), 1000u);
  for (std::size_t i = 0; i < out.truth.size(); ++i) EXPECT_NEAR(out.scan.points[i].x, 20.0, 2 * 0.25e-3 + 1e-4);
}

/// Rays are traced about the middle of a tile nearby, so that only the corners' own rounding counts, and here there is
/// none: what is left is that of their origin, half a unit in the last place up to 256 m from the middle, 1.5e-5 m, and
/// of the point itself, 2e-6 m.
TEST(Extremes, FarAwayExactCornersGiveExactRanges) {
  const double far_m = 12'000.25;
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {far_m + 20, far_m - 100}, {far_m + 20, far_m + 100}, 60);
  LidarConfig config = ideal_lidar();
  const LidarOutput out = scan_of(parts, config, pose_at(far_m, far_m, 2, 0));
  ASSERT_GT(out.truth.size(), 1000u);
  for (std::size_t i = 0; i < out.truth.size(); ++i) EXPECT_NEAR(out.scan.points[i].x, 20.0, 1.7e-5);
}

}  // namespace
}  // namespace canyon::lidar
