#include "canyon/scene/surfaces/facet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"
#include "canyon/tests/scene/small_scenes.h"

namespace canyon::scene::testing {
namespace {

TEST(Facets, ABoxHasFourWallsAndARoof) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  add_building(parts, rectangle(10, -5, 20, 15), -0.5, 8.0);
  const Scene scene(std::move(parts));
  EXPECT_FALSE(scene.facets_built());
  const auto& facets = scene.facets().facets();
  EXPECT_TRUE(scene.facets_built());
  ASSERT_EQ(facets.size(), 5u) << "the ground gives none";
  Eigen::Vector3d closing = Eigen::Vector3d::Zero();
  double area_m2 = 0.0;
  for (const Facet& f : facets) {
    EXPECT_EQ(f.triangles.size(), 2u);
    closing += f.area_m2 * f.normal_W;
    area_m2 += f.area_m2;
    const Eigen::Vector3d outward = f.center_W - Eigen::Vector3d(15, 5, 3.75);
    EXPECT_GT(f.normal_W.dot(outward), 0.0);
    EXPECT_NEAR(f.normal_W.dot(f.center_W), f.offset_m, 8 * 2.3e-16 * 20.0);
  }
  EXPECT_NEAR((closing - Eigen::Vector3d(0, 0, 200)).norm(), 0.0, 64 * 2.3e-16 * 200.0) << "open at the bottom";
  EXPECT_NEAR(area_m2, 2 * (10 + 20) * 8.5 + 200, 64 * 2.3e-16 * 710.0);
}

TEST(Facets, AnLHasSixWallsAndOneRoofWithItsYardOutside) {
  SceneParts parts = empty_parts();
  add_building(parts, l_outline(), 0.0, 8.0);
  const Scene scene(std::move(parts));
  const auto& facets = scene.facets().facets();
  ASSERT_EQ(facets.size(), 7u);
  const auto roof = std::find_if(facets.begin(), facets.end(), [](const Facet& f) { return f.normal_W.z() > 0.5; });
  ASSERT_NE(roof, facets.end());
  EXPECT_NEAR(roof->area_m2, 300.0, 64 * 2.3e-16 * 300.0);
  EXPECT_TRUE(facet_contains(*roof, scene, {5, 15, 8}));
  EXPECT_TRUE(facet_contains(*roof, scene, {15, 5, 8}));
  EXPECT_FALSE(facet_contains(*roof, scene, {15, 15, 8})) << "the yard is a hole in the bounding square";
  EXPECT_TRUE(facet_contains(*roof, scene, {10, 10, 8})) << "an edge counts as inside";
  EXPECT_TRUE(facet_contains(*roof, scene, {5, 0, 8}));
  EXPECT_TRUE(facet_contains(*roof, scene, {5, -0.9e-9, 8}));
  EXPECT_FALSE(facet_contains(*roof, scene, {5, -1.1e-9, 8}));
}

TEST(Facets, ContainsAgreesWithRaysOnEveryFacetOfACity) {
  CityConfig config;
  config.terrain_cell_m = 10.0;
  const Scene scene(make_city(config));
  const SceneAt at(scene);
  const RandomStream stream(5, "test.facets");
  const auto& facets = scene.facets().facets();
  int inside = 0, outside = 0;
  for (std::uint32_t i = 0; i < facets.size(); i += 7) {
    const Facet& f = facets[i];
    Eigen::Vector3d p = f.center_W + f.radius_m * stream.uniform(0.0, 1.2, 1, i) * stream.direction(0, i);
    p -= (f.normal_W.dot(p) - f.offset_m) * f.normal_W;
    // A short ray through p along the normal meets one of the facet's triangles exactly if the facet contains p.
    const Ray through{p + 5e-3 * f.normal_W, (-f.normal_W).cast<float>(), 1e-2f};
    const Hit hit = at.trace(through);
    const bool met = hit.hit() && std::binary_search(f.triangles.begin(), f.triangles.end(), hit.triangle);
    double edge_m = 1e300;
    for (const std::uint32_t t : f.triangles)
      edge_m = std::min(edge_m, edge_distance(Triangle::of(scene.mesh(), t), p));
    if (edge_m < 1e-3 || (hit.hit() && !met)) continue;  // single precision; or something else is in the way
    EXPECT_EQ(facet_contains(f, scene, p), met) << i;
    (met ? inside : outside)++;
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(outside, 300);
}

TEST(Facets, MergeNeedsOnePlaneOneMaterialAndACommonEdge) {
  const auto count = [](auto add) {
    SceneParts parts = empty_parts();
    MeshBuilder mesh(parts);
    mesh.begin_object("wall", ObjectKind::kWall);
    add(mesh);
    return Scene(std::move(parts)).facets().facets().size();
  };
  const auto wall = [](MeshBuilder& mesh, double x0, double x1, double y1, std::uint16_t material) {
    mesh.quad({x0, 0, 0}, {x1, y1, 0}, {x1, y1, 3}, {x0, 0, 3}, material);
  };
  EXPECT_EQ(count([&](MeshBuilder& m) { wall(m, 0, 5, 0, 0), wall(m, 5, 10, 0, 0); }), 1u);
  EXPECT_EQ(count([&](MeshBuilder& m) { wall(m, 0, 5, 0, 0), wall(m, 5, 10, 0, 1); }), 2u) << "materials differ";
  EXPECT_EQ(count([&](MeshBuilder& m) { wall(m, 0, 5, 0, 0), wall(m, 6, 10, 0, 0); }), 2u) << "no common edge";
  // A bend of 0.05 deg over 5 m leaves the plane by 4 mm, one of 0.5 deg by 4 cm.
  EXPECT_EQ(count([&](MeshBuilder& m) {
              wall(m, 0, 5, 0, 0), m.quad({5, 0, 0}, {10, 0.0044, 0}, {10, 0.0044, 3}, {5, 0, 3}, 0);
            }),
            1u);
  EXPECT_EQ(count([&](MeshBuilder& m) {
              wall(m, 0, 5, 0, 0), m.quad({5, 0, 0}, {10, 0.044, 0}, {10, 0.044, 3}, {5, 0, 3}, 0);
            }),
            2u);
  EXPECT_EQ(count([&](MeshBuilder& m) {
              m.quad({0, 0, 0}, {0.9, 0, 0}, {0.9, 0, 1}, {0, 0, 1}, 0);
            }),
            0u)
      << "below 1 m^2";
}

TEST(Facets, NearIsTheSameAsTryingAll) {
  CityConfig config;
  config.terrain_cell_m = 10.0;
  const Scene scene(make_city(config));
  const FacetIndex& index = scene.facets();
  const RandomStream stream(6, "test.near");
  std::vector<std::uint32_t> found;
  std::size_t total = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Eigen::Vector3d p(stream.uniform(-700, 700, 0, i), stream.uniform(-700, 700, 1, i),
                            stream.uniform(-30, 100, 2, i));
    const double radius_m = i % 10 == 0 ? 2000.0 : stream.uniform(0.0, 80.0, 3, i);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t k = 0; k < index.facets().size(); ++k) {
      const Facet& f = index.facets()[k];
      if ((f.center_W - p).norm() <= radius_m + f.radius_m) expected.push_back(k);
    }
    index.near(p, radius_m, found);
    ASSERT_EQ(found, expected) << i;
    total += found.size();
  }
  EXPECT_GT(total, 1000u);
  FacetIndex().near({0, 0, 0}, 10.0, found);
  EXPECT_TRUE(found.empty());
}

TEST(Facets, ThoseThatMirrorOverTheirBordersAreFound) {
  CityConfig config;
  config.extent_m = 2000.0;
  config.terrain_cell_m = 20.0;
  const Scene scene(make_city(config));
  const auto& facets = scene.facets().facets();
  const RandomStream stream(8, "test.over_borders");
  std::size_t all = 0, needed = 0, listed = 0, sharp = 0;
  for (std::uint64_t i = 0; i < 12; ++i) {
    const Eigen::Vector3d p_W(stream.uniform(-900, 900, 0, i), stream.uniform(-900, 900, 1, i),
                              i % 3 == 0 ? 30.0 : 2.0);
    const double elevation_rad = i % 2 == 0 ? 0.09 : 0.3, detour_m = i % 4 < 2 ? 0.25 : 1.3;
    std::vector<std::uint32_t> found;
    scene.facets().mirrors(p_W, elevation_rad, 1e9, 1e9, found);
    sharp += found.size();
    scene.facets().mirrors(p_W, elevation_rad, 1e9, 1e9, found, detour_m);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    listed += found.size();
    all += facets.size();
    for (std::uint32_t k = 0; k < facets.size(); ++k) {
      const Facet& f = facets[k];
      const double before_m = f.normal_W.dot(p_W) - f.offset_m;
      if (before_m <= 0.0) continue;
      const Eigen::Vector3d image_W = p_W - 2.0 * before_m * f.normal_W;
      // To a corner of it, by the wave of all from above that elevation that makes the shortest detour there.
      const bool sends = std::any_of(f.borders.begin(), f.borders.end(), [&](const FacetBorder& side) {
        const Eigen::Vector3d way_W = side.from_W - image_W;
        const double turn_rad = std::max(elevation_rad - std::asin(way_W.normalized().z()), 0.0);
        return turn_rad < 0.5 * kPi && way_W.norm() * (1.0 - std::cos(turn_rad)) <= detour_m;
      });
      if (!sends) continue;
      ++needed;
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), k)) << "place " << i << ", facet " << k;
    }
  }
  EXPECT_LT(sharp, listed);
  EXPECT_LT(needed, listed);
  EXPECT_LT(listed, all / 2);
}

TEST(Facets, AreBuiltOnceWhateverTheNumberOfThreads) {
  CityConfig config;
  config.terrain_cell_m = 10.0;
  const Scene scene(make_city(config));
  std::atomic<const FacetIndex*> seen[8] = {};
  std::vector<std::thread> threads;
  for (auto& slot : seen) threads.emplace_back([&] { slot = &scene.facets(); });
  for (std::thread& t : threads) t.join();
  for (const auto& slot : seen) EXPECT_EQ(slot.load(), &scene.facets());
}

}  // namespace
}  // namespace canyon::scene::testing
