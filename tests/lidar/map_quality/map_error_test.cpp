#include "canyon/lidar/map_quality/map_error.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

/// Points spread over [-30, 30]^2 at a height.
MapCloud sheet(double height_m, std::uint32_t n = 5000) {
  const RandomStream random(2, "test.sheet");
  std::vector<MapPoint> points(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    points[i].p_W =
        Eigen::Vector3d(random.uniform(-30, 30, 0, i), random.uniform(-30, 30, 1, i), height_m).cast<float>();
  }
  return MapCloud(points);
}

TEST(MapQuality, APlaneTwoMetresTooHigh) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 100);
  const scene::Scene scene(parts);
  auto points = sheet(2.0);
  const auto [q, error_m] = evaluate_map(points, scene::SceneAt(scene));
  EXPECT_EQ(q.points, 5000);
  EXPECT_EQ(q.up_points, 5000);
  EXPECT_EQ(q.capped_points, 0);
  // Single-precision geometry of 100 m.
  EXPECT_NEAR(q.map_error_rms_m, 2.0, 1e-5);
  EXPECT_NEAR(q.map_error_up_rms_m, 2.0, 1e-5);
  EXPECT_NEAR(q.map_error_up_mean_m, 2.0, 1e-5);
  EXPECT_NEAR(q.map_error_p95_m, 2.0, 1e-5);
  for (const float e : error_m) EXPECT_NEAR(e, 2.0, 1e-5);
  auto below = sheet(-0.5);
  EXPECT_NEAR(evaluate_map(below, scene::SceneAt(scene)).quality.map_error_up_mean_m, -0.5, 1e-5);
}

TEST(MapQuality, WallsShowSidewaysErrorsOnly) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {10, -50}, {10, 50}, 30);
  const scene::Scene scene(parts);
  std::vector<MapPoint> points(100);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].p_W = {10.25f, static_cast<float>(i) - 50, 12.0f};
  MapCloud cloud(points);
  const MapQuality q = evaluate_map(cloud, scene::SceneAt(scene)).quality;
  EXPECT_NEAR(q.map_error_rms_m, 0.25, 1e-5);
  EXPECT_EQ(q.up_points, 0);
  EXPECT_TRUE(std::isnan(q.map_error_up_rms_m));
}

TEST(MapQuality, TreesSayNothingAboutHeight) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 100);
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("tree", scene::ObjectKind::kTree);
  mesh.quad({-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}, mesh.material("asphalt"));
  const scene::Scene scene(parts);
  MapCloud points(std::vector<MapPoint>{{.p_W = {0, 0, 3.1f}}, {.p_W = {20, 0, 0.2f}}});
  const MapQuality q = evaluate_map(points, scene::SceneAt(scene)).quality;
  EXPECT_EQ(q.up_points, 1);
  EXPECT_NEAR(q.map_error_up_rms_m, 0.2, 1e-5);
  EXPECT_NEAR(q.map_error_rms_m, std::sqrt((0.1 * 0.1 + 0.2 * 0.2) / 2), 1e-5);
}

TEST(MapQuality, FarPointsCountWithTheCap) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 100);
  const scene::Scene scene(parts);
  MapCloud points = sheet(0.0, 3);
  points.push_back({.p_W = {0, 0, 80}});
  const auto [q, error_m] = evaluate_map(points, scene::SceneAt(scene), 4.0);
  EXPECT_EQ(q.capped_points, 1);
  EXPECT_EQ(q.up_points, 3);
  EXPECT_EQ(error_m[3], 4.0f);
  EXPECT_NEAR(q.map_error_rms_m, 2.0, 1e-6);
  EXPECT_EQ(q.map_error_p95_m, 4.0) << "nearest rank: the fourth of four";
}

TEST(MapQuality, EmptyMapIsUndefined) {
  const scene::Scene scene(testing::empty_parts());
  MapCloud empty;
  const MapQuality none = evaluate_map(empty, scene::SceneAt(scene)).quality;
  EXPECT_EQ(none.points, 0);
  EXPECT_TRUE(std::isnan(none.map_error_rms_m));
  EXPECT_TRUE(std::isnan(none.map_error_p95_m));
  // An empty scene: every point is far from everything.
  auto points = sheet(0.0, 10);
  EXPECT_EQ(evaluate_map(points, scene::SceneAt(scene)).quality.capped_points, 10);
}

TEST(MapQuality, SameBitsForAnyNumberOfThreads) {
  const scene::Scene scene(testing::street_crossing());
  std::vector<MapQuality> results;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    auto points = sheet(1.3, 20000);
    results.push_back(evaluate_map(points, scene::SceneAt(scene)).quality);
  }
  set_threads(0);
  for (const MapQuality& q : results) {
    EXPECT_EQ(q.map_error_rms_m, results[0].map_error_rms_m);
    EXPECT_EQ(q.map_error_up_rms_m, results[0].map_error_up_rms_m);
    EXPECT_EQ(q.map_error_p95_m, results[0].map_error_p95_m);
  }
}

}  // namespace
}  // namespace canyon::lidar
