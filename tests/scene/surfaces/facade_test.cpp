#include "canyon/scene/surfaces/facade.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "canyon/scene/city/city.h"
#include "canyon/tests/scene/small_scenes.h"

namespace canyon::scene::testing {
namespace {

TEST(Facades, OfABoxItsFourWallsAndNothingElse) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  add_building(parts, rectangle(10, -5, 20, 15), -0.5, 8.0);
  parts.buildings[0].base_m = 0.25;
  MeshBuilder mesh(parts);
  mesh.begin_object("garden wall", ObjectKind::kWall);
  const std::uint16_t brick = mesh.material("brick"), asphalt = mesh.material("asphalt"),
                      concrete = mesh.material("concrete");
  mesh.quad({0, 0, 0}, {0, 9, 0}, {0, 9, 3}, {0, 0, 3}, brick);
  const Scene scene(std::move(parts));
  const FacadeIndex& walls = scene.facades();
  ASSERT_EQ(walls.facades().size(), 4u);
  EXPECT_TRUE(walls.any_of(brick));
  EXPECT_FALSE(walls.any_of(asphalt));
  EXPECT_FALSE(walls.any_of(concrete)) << "the roof's";
  std::multiset<double> widths;
  for (const Facade& wall : walls.facades()) {
    EXPECT_DOUBLE_EQ(wall.along_W.norm(), 1.0);
    EXPECT_EQ(wall.bottom_m, -0.5);
    EXPECT_EQ(wall.top_m, 8.0);
    EXPECT_EQ(wall.base_m, 0.25) << "the building's, not the wall's";
    widths.insert(wall.end_m - wall.begin_m);
  }
  EXPECT_EQ(widths, (std::multiset<double>{10.0, 10.0, 20.0, 20.0}));
  std::size_t of_walls = 0;
  for (std::uint32_t i = 0; i < scene.mesh().triangles.size(); ++i) {
    const Triangle t = Triangle::of(scene.mesh(), i);
    const bool wall = std::abs(t.area_normal().normalized().z()) < 0.5 &&
                      scene.objects()[scene.mesh().object[i]].kind == ObjectKind::kBuilding;
    EXPECT_EQ(walls.of(i) != FacadeIndex::kNone, wall) << i;
    of_walls += wall ? 1 : 0;
  }
  EXPECT_EQ(of_walls, 8u);
  EXPECT_EQ(walls.of(static_cast<std::uint32_t>(scene.mesh().triangles.size())), FacadeIndex::kNone)
      << "a moving thing's";
}

TEST(Facades, BaysAndFloorsThatFit) {
  const auto of = [](double width_m, double bottom_m, double top_m) {
    Facade wall{.along_W = {1.0, 0.0},
                .begin_m = -4.0,
                .end_m = -4.0 + width_m,
                .bottom_m = bottom_m,
                .top_m = top_m,
                .base_m = 1.0};
    wall.divide();
    EXPECT_NEAR(wall.bays_per_m * width_m, wall.bays, 1e-12);
    return std::array<double, 3>{wall.bays, wall.first_floor, wall.end_floor};
  };
  using Found = std::array<double, 3>;
  EXPECT_EQ(of(12.0, 0.5, 10.0), (Found{4, 0, 3}));
  EXPECT_EQ(of(14.9, 0.5, 12.9), (Found{4, 0, 3}));
  EXPECT_EQ(of(3.0, 1.0, 4.0), (Found{1, 0, 1}));
  EXPECT_EQ(of(2.9, 1.0, 31.0)[0], 0.0) << "narrower than a bay";
  EXPECT_EQ(of(30.0, 1.0, 3.9)[2], 0.0) << "lower than a floor";
  EXPECT_EQ(of(9.0, 11.0, 15.0), (Found{3, 4, 4})) << "a machine room across the floor from 9 to 12 m";
  EXPECT_EQ(of(9.0, 10.0, 16.0), (Found{3, 3, 5})) << "one whose floors are whole";
}

TEST(Facades, OfTheBuiltInCityEveryBuildingHasSome) {
  CityConfig config;
  config.terrain_cell_m = 10.0;
  const Scene scene(make_city(config));
  const FacadeIndex& walls = scene.facades();
  std::set<std::uint32_t> objects;
  for (std::uint32_t i = 0; i < scene.mesh().triangles.size(); ++i) {
    if (walls.of(i) == FacadeIndex::kNone) continue;
    objects.insert(scene.mesh().object[i]);
    const Facade& wall = walls.facades()[walls.of(i)];
    for (const std::uint32_t v : scene.mesh().triangles[i]) {
      const Eigen::Vector3d p = scene.mesh().vertices[v].cast<double>();
      const double along_m = wall.along_W.dot(p.head<2>());
      EXPECT_TRUE(along_m >= wall.begin_m && along_m <= wall.end_m && p.z() >= wall.bottom_m && p.z() <= wall.top_m);
    }
  }
  EXPECT_EQ(objects.size(), scene.buildings().size());
}

}  // namespace
}  // namespace canyon::scene::testing
