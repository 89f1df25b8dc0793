#include "canyon/scene/scene.h"

#include <gtest/gtest.h>

#include <limits>

#include "canyon/core/check.h"
#include "canyon/tests/scene/small_scenes.h"

namespace canyon::scene::testing {
namespace {

TEST(Scene, UnusableTrianglesAreDroppedAndCounted) {
  SceneParts parts = empty_parts();
  MeshBuilder mesh(parts);
  mesh.begin_object("terrain", ObjectKind::kTerrain);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  mesh.triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, 1);        // no area
  mesh.triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1);        // a point
  mesh.triangle({0, 0, nan}, {1, 0, 0}, {0, 1, 0}, 1);      // not a number
  mesh.triangle({0, 0, 0}, {inf, 0, 0}, {0, 1, 0}, 1);      // infinite
  mesh.triangle({0, 0, 0}, {100, 0, 0}, {50, 1e-8, 0}, 1);  // thinner than a micrometre
  mesh.triangle({-5, -5, 0}, {5, -5, 0}, {0, 5, 0}, 2);     // good
  const Scene scene(std::move(parts));
  EXPECT_EQ(scene.dropped_triangles(), 5u);
  ASSERT_EQ(scene.mesh().triangles.size(), 1u);
  EXPECT_EQ(scene.mesh().material[0], 2);
  EXPECT_EQ(scene.extent().max, Eigen::Vector3d(5, 5, 0));
  const Hit hit = SceneAt(scene).trace({{0, 0, 1}, {0, 0, -1}});
  EXPECT_EQ(hit.triangle, 0u);
  EXPECT_EQ(hit.range_m, 1.0f);
}

TEST(Scene, WithoutAnyTriangleAnswersMiss) {
  const Scene scene(empty_parts());
  const SceneAt at(scene);
  EXPECT_FALSE(at.trace({{0, 0, 1}, {0, 0, -1}}).hit());
  EXPECT_EQ(at.nearest({0, 0, 0}, 100.0).triangle, Hit::kMiss);
  EXPECT_FALSE(at.blocked({0, 0, 0}, {1, 1, 1}));
  EXPECT_FALSE(scene.ground(0, 0).has_value());
  EXPECT_TRUE(scene.facets().facets().empty());
}

TEST(Scene, WrongIndicesAreAProgrammersMistake) {
  SceneParts parts = empty_parts();
  add_plane(parts, 1.0, 0.0);
  parts.mesh.triangles[0][2] = 99;
  EXPECT_THROW(Scene{std::move(parts)}, ProgramError);
  SceneParts materials = empty_parts();
  add_plane(materials, 1.0, 0.0);
  materials.mesh.material[1] = 999;
  EXPECT_THROW(Scene{std::move(materials)}, ProgramError);
}

TEST(Scene, GroundIsThePlaneAndOnlyTheTerrain) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 3.0, 0.05);
  add_building(parts, rectangle(10, -5, 12, 5), 0.0, 10.0);
  const Scene scene(std::move(parts));
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.05, 0, 1).normalized();
  for (const double x : {-80.3, 0.0, 11.0, 57.1}) {  // 11 is under the building
    const auto ground = scene.ground(x, 0.7);
    ASSERT_TRUE(ground.has_value());
    // The terrain's corners are floats: half a unit in the last place of 8 m.
    EXPECT_NEAR(ground->height_m, 3.0 + 0.05 * x, 0.5e-6);
    EXPECT_NEAR((ground->normal_W - normal).norm(), 0.0, 1e-7);
  }
  EXPECT_FALSE(scene.ground(100.1, 0.0).has_value());
  EXPECT_FALSE(scene.ground(std::nan(""), 0.0).has_value());
}

TEST(Scene, BuildingAtKnowsTheInnerCornerOfAnL) {
  SceneParts parts = empty_parts();
  add_building(parts, l_outline(), 0.0, 10.0);
  add_building(parts, rectangle(30, 0, 40, 10), 0.0, 10.0);
  const Scene scene(std::move(parts));
  ASSERT_NE(scene.building_at({5, 15}), nullptr);
  EXPECT_EQ(scene.building_at({5, 15})->name, "building 1");
  EXPECT_EQ(scene.building_at({15, 15}), nullptr) << "the yard";
  EXPECT_EQ(scene.building_at({35, 5})->name, "building 2");
  EXPECT_EQ(scene.building_at({25, 5}), nullptr);
}

TEST(Scene, HashFollowsGeometryMaterialsAndFrame) {
  const auto build = [](auto change) {
    SceneParts parts = empty_parts();
    add_plane(parts, 10.0, 0.0);
    change(parts);
    return Scene(std::move(parts)).hash();
  };
  const std::string plain = build([](SceneParts&) {});
  EXPECT_EQ(plain.size(), 64u);
  EXPECT_EQ(plain, build([](SceneParts&) {}));
  EXPECT_NE(plain, build([](SceneParts& p) { p.mesh.vertices[0].z() += 1e-3f; }));
  EXPECT_NE(plain, build([](SceneParts& p) { p.mesh.material[0] = 1; }));
  EXPECT_NE(plain, build([](SceneParts& p) { p.materials[3].rf_absorbing = true; }));
  EXPECT_NE(plain, build([](SceneParts& p) { p.frame = LocalFrame({0.5, 0.1, 10.0}); }));
  EXPECT_EQ(plain, build([](SceneParts& p) { p.name = "other"; })) << "a name is no geometry";
}

}  // namespace
}  // namespace canyon::scene::testing
