#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/scene/import.h"
#include "canyon/scene/inspect.h"
#include "canyon/tests/scene/small_scenes.h"
#include "canyon/tests/support/outside_program.h"

/// Input that no one wishes for, and what then holds.
namespace canyon::scene::testing {
namespace {

TEST(Degenerate, AnEmptySceneAnswersEverything) {
  const Scene scene(empty_parts());
  const SceneAt at(scene);
  EXPECT_FALSE(at.trace({{0, 0, 1}, {1, 0, 0}}).hit());
  EXPECT_FALSE(at.blocked({0, 0, 0}, {100, 0, 0}));
  EXPECT_FALSE(scene.ground(0, 0).has_value());
  EXPECT_EQ(scene.building_at({0, 0}), nullptr);
  EXPECT_TRUE(scene.facets().facets().empty());
  EXPECT_TRUE(scene.edges().edges().empty());
  EXPECT_EQ(soundness(scene).objects, 0u);
  EXPECT_TRUE(material_areas(scene).empty());
  EXPECT_EQ(sensor_needs(scene).reflecting_facets, 0u);
}

TEST(Degenerate, TrianglesThatNoRayCanMeetAreDroppedAndCountedFromFiles) {
  const canyon::testing::ScratchDirectory scratch;
  const std::string path = scratch.file("bad.obj");
  // A good triangle; two of no area; one with a corner that is not a number; a corner twice at the same place.
  std::ofstream(path)
      << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv nan 0 0\nv 0 0 0\nv 1 0 0\n"
         "v -9 -9 -1\nv 9 -9 -1\nv 0 9 -1\no ground\nf 8 9 10\no plate\nf 1 2 3\nf 1 2 4\nf 1 1 2\nf 1 2 5\nf 6 7 3\n";
  ImportConfig config;
  config.file = path;
  const auto made = import_scene(config, {});
  ASSERT_TRUE(made.ok()) << made.error().str();
  const Scene scene(made->parts);
  EXPECT_EQ(scene.mesh().triangles.size(), 3u);
  EXPECT_EQ(scene.dropped_triangles(), 3u);
  EXPECT_TRUE(scene.extent().max.allFinite());
  EXPECT_EQ(soundness(scene).repeated_triangles, 1u);  // by place, not by index
  EXPECT_NEAR(SceneAt(scene).trace({{0.2, 0.2, 1}, {0, 0, -1}}).range_m, 1.0, 1e-6);
}

TEST(Degenerate, InvertedNormalsStopRaysJustTheSame) {
  SceneParts parts = empty_parts();
  add_building(parts, rectangle(10, -5, 20, 5), 0.0, 12.0);
  SceneParts inverted = parts;
  for (auto& t : inverted.mesh.triangles) std::swap(t[0], t[1]);
  const Scene scene(std::move(parts)), other(std::move(inverted));
  const Hit a = SceneAt(scene).trace({{0, 0, 5}, {1, 0, 0}}), b = SceneAt(other).trace({{0, 0, 5}, {1, 0, 0}});
  EXPECT_EQ(a.range_m, b.range_m);
  EXPECT_EQ(a.normal, b.normal);  // it faces the ray's origin, however the triangle is wound
  // Facets keep the file's sense: outward is where the triangles face.
  ASSERT_EQ(scene.facets().facets().size(), other.facets().facets().size());
  for (std::size_t i = 0; i < scene.facets().facets().size(); ++i)
    EXPECT_LT((scene.facets().facets()[i].normal_W + other.facets().facets()[i].normal_W).norm(), 1e-9);
}

TEST(Degenerate, ASensorInsideAWallMeetsItsOtherSide) {
  SceneParts parts = empty_parts();
  add_building(parts, rectangle(10, -5, 10.4, 5), 0.0, 12.0);
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  EXPECT_NEAR(at.trace({{10.2, 0, 5}, {1, 0, 0}}).range_m, 0.2, 1e-6);
  // On the surface itself: at once, or past it to the other side.
  const Hit on = at.trace({{10.0, 0, 5}, {1, 0, 0}});
  EXPECT_TRUE(on.range_m == 0.0f || std::abs(on.range_m - 0.4f) < 1e-6f) << on.range_m;
  EXPECT_TRUE(at.blocked_towards({10.2, 0, 5}, {0, 1, 0}));
}

/// Coordinates of W in single precision: 0.24 mm steps at 5 km. The wall's corners and the ray's origin are rounded by
/// half of that each, along the ray and, for a wall turned by 45 degrees, across it.
TEST(Degenerate, FiveKilometresFromTheOrigin) {
  const RandomStream random(5, "test.far");
  double worst_m = 0.0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    const double bearing = random.uniform(-kPi, kPi, 0, i);
    const Eigen::Vector3d place(5000.0 * std::cos(bearing), 5000.0 * std::sin(bearing), 0.0);
    const double turn = random.uniform(-kPi, kPi, 1, i), range_m = random.uniform(1.0, 100.0, 2, i);
    const Eigen::Vector3d ahead(std::cos(turn), std::sin(turn), 0.0), left(-ahead.y(), ahead.x(), 0.0);
    SceneParts parts = empty_parts();
    MeshBuilder mesh(parts);
    mesh.begin_object("wall", ObjectKind::kWall);
    const Eigen::Vector3d foot = place + range_m * ahead;
    mesh.quad(foot - 20 * left, foot + 20 * left, foot + 20 * left + Eigen::Vector3d(0, 0, 10),
              foot - 20 * left + Eigen::Vector3d(0, 0, 10), 0);
    const Scene scene(std::move(parts));
    const Hit hit = SceneAt(scene).trace({place + Eigen::Vector3d(0, 0, 2), ahead.cast<float>()});
    ASSERT_TRUE(hit.hit()) << i;
    worst_m = std::max(worst_m, std::abs(hit.range_m - range_m));
  }
  EXPECT_LT(worst_m, 2 * 0.5 * 2.4414e-4 * std::sqrt(2.0) * 1.5);
  std::printf("  largest range error at 5 km from the origin: %.2f mm\n", 1e3 * worst_m);
}

/// A plane met at 89.99 degrees: the range is 5730 times the height above it, so that the rounding of a height of 1 m
/// in single precision (6e-8 m) and of the direction (3e-8 rad) moves it by 5730^2 x 3e-8 m = 1 m.
TEST(Degenerate, GrazingAt89_99Degrees) {
  SceneParts parts = empty_parts();
  add_plane(parts, 20000.0, 0.0);
  const Scene scene(std::move(parts));
  const double below = 0.01 * kDegree;
  const Hit hit =
      SceneAt(scene).trace({{0, 0, 1}, Eigen::Vector3d(std::cos(below), 0, -std::sin(below)).cast<float>()});
  ASSERT_TRUE(hit.hit());
  EXPECT_NEAR(hit.range_m, 1.0 / std::sin(below), 1.0 * 2.0);
  EXPECT_FALSE(SceneAt(scene).trace({{0, 0, 1}, {1, 0, 0}}).hit());  // along it: nothing
}

double resident_mb() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * 4096.0 / 1e6;
}

/// Ten million triangles: a hilly grid. What it takes is printed; rays agree with the function behind it.
TEST(Degenerate, TenMillionTrianglesNightly) {
  const double before_mb = resident_mb();
  constexpr int kSide = 2236;  // 2 x 2236^2 = 9,999,392
  const auto height = [](double x, double y) { return 5.0 * std::sin(0.01 * x) * std::cos(0.013 * y); };
  SceneParts parts = empty_parts();
  MeshBuilder(parts).begin_object("terrain", ObjectKind::kTerrain);
  Mesh& mesh = parts.mesh;
  for (int r = 0; r <= kSide; ++r)
    for (int c = 0; c <= kSide; ++c)
      mesh.vertices.emplace_back(static_cast<float>(c - 1118), static_cast<float>(r - 1118),
                                 static_cast<float>(height(c - 1118, r - 1118)));
  const auto at = [](int c, int r) { return static_cast<std::uint32_t>(r * (kSide + 1) + c); };
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      mesh.triangles.push_back({at(c, r), at(c + 1, r), at(c + 1, r + 1)});
      mesh.triangles.push_back({at(c, r), at(c + 1, r + 1), at(c, r + 1)});
    }
  }
  mesh.material.assign(mesh.triangles.size(), 0);
  mesh.object.assign(mesh.triangles.size(), 0);
  const auto start = std::chrono::steady_clock::now();
  const Scene scene(std::move(parts));
  const double build_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("  %zu triangles: %.0f MB, built in %.1f s\n", scene.mesh().triangles.size(), resident_mb() - before_mb,
              build_s);
  const SceneAt scene_at(scene);
  const RandomStream random(8, "test.many");
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const double x = random.uniform(-1100, 1100, 0, i), y = random.uniform(-1100, 1100, 1, i);
    const Hit hit = scene_at.trace({{x, y, 100.0}, {0, 0, -1}});
    ASSERT_TRUE(hit.hit());
    // Chords of 1 m lie off the curve by at most second derivative / 8 = (0.01^2 + 0.013^2 + 2 x 0.01 x 0.013) x 5 / 8.
    EXPECT_NEAR(100.0 - hit.range_m, height(x, y), 5 * 5.3e-4 / 8 + 2e-5);
  }
}

}  // namespace
}  // namespace canyon::scene::testing
