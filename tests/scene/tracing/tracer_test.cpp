#include <gtest/gtest.h>

#include <algorithm>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"
#include "canyon/tests/scene/small_scenes.h"

namespace canyon::scene::testing {
namespace {

constexpr double kFloatEps = 1.0 / (1 << 23);

Ray ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return {in_single_precision(origin), direction.normalized().cast<float>()};
}

/// Rays from points above the streets of a city, mostly level and a little down.
std::vector<Ray> city_rays(std::size_t count) {
  const RandomStream stream(7, "test.rays");
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<std::uint32_t>(i);
    const Eigen::Vector3d origin(stream.uniform(-480, 480, 0, n), stream.uniform(-480, 480, 1, n),
                                 stream.uniform(10, 40, 2, n));
    Eigen::Vector3d direction = stream.direction(3, n);
    direction.z() = 0.5 * direction.z() - 0.2;
    rays.push_back(ray(origin, direction));
  }
  return rays;
}

CityConfig coarse_city() {
  CityConfig config;
  config.terrain_cell_m = 10.0;  // the oracle tries every triangle
  return config;
}

TEST(Trace, PlaneHasTheClosedFormRange) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, -2.0);
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  const RandomStream stream(1, "test.plane");
  for (std::uint32_t i = 0; i < 200; ++i) {
    Eigen::Vector3d direction = stream.direction(0, i);
    direction.z() = -std::abs(direction.z()) - 0.05;
    const Ray r = ray({stream.uniform(-3, 3, 1, i), stream.uniform(-3, 3, 2, i), 1.0}, direction);
    const Hit hit = at.trace(r);
    const double expected = (-2.0 - r.origin.z()) / double{r.direction.z()};
    ASSERT_TRUE(hit.hit());
    EXPECT_NEAR(hit.range_m, expected, kFloatEps * expected);
    EXPECT_EQ(hit.normal, Eigen::Vector3f(0, 0, 1));
  }
  EXPECT_FALSE(at.trace(ray({0, 0, 1}, {0, 0, 1})).hit());
}

TEST(Trace, NormalFacesTheRayFromEitherSide) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  EXPECT_EQ(at.trace(ray({0.3, 0.1, 1}, {0, 0, -1})).normal.z(), 1.0f);
  EXPECT_EQ(at.trace(ray({0.3, 0.1, -1}, {0, 0, 1})).normal.z(), -1.0f);
}

TEST(Trace, BoxFromInsideAndOutside) {
  SceneParts parts = empty_parts();
  MeshBuilder mesh(parts);
  mesh.begin_object("box", ObjectKind::kOther);
  mesh.box({5, 0, 0}, Eigen::Matrix3d::Identity(), {1, 2, 3}, 0);
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  EXPECT_EQ(at.trace(ray({0, 0.1, 0.2}, {1, 0, 0})).range_m, 4.0f);
  EXPECT_EQ(at.trace(ray({5, 0.1, 0.2}, {1, 0, 0})).range_m, 1.0f);
  EXPECT_EQ(at.trace(ray({5, 0.1, 0.2}, {0, 1, 0})).range_m, 2.0f - 0.1f);
  EXPECT_EQ(at.trace(ray({5, 0.1, 0.25}, {0, 0, -1})).range_m, 3.25f);
  EXPECT_FALSE(at.trace(ray({0, 0.1, 0.2}, {-1, 0, 0})).hit());
  Ray limited = ray({0, 0.1, 0.2}, {1, 0, 0});
  limited.max_m = 3.999f;
  EXPECT_FALSE(at.trace(limited).hit());
}

// Along an edge shared by two triangles a ray must not slip through (Embree's robust mode).
TEST(Trace, SharedEdgesAreWatertight) {
  const CityConfig config = {.terrain_cell_m = 10.0, .empty = true};
  const Scene scene(make_city(config));
  const SceneAt at(scene);
  for (int i = -48; i < 48; ++i) {
    for (int j = -48; j < 48; ++j) {
      const Ray down{{10.0 * i, 10.0 * j, 300.0}, {0.0f, 0.0f, -1.0f}};
      ASSERT_TRUE(at.trace(down).hit()) << i << " " << j;
    }
  }
}

TEST(Trace, AgreesWithTheDoublePrecisionOracle) {
  const Scene scene(make_city(coarse_city()));
  const SceneAt at(scene);
  int hits = 0, at_edges = 0;
  for (const Ray& r : city_rays(400)) {
    const Hit hit = at.trace(r);
    const OracleHit oracle = trace_all(scene.mesh(), r);
    hits += oracle.triangle != Hit::kMiss;
    if (hit.triangle == oracle.triangle) {
      // Both in double precision, rounded once to float.
      if (hit.hit()) {
        EXPECT_NEAR(hit.range_m, oracle.range_m, kFloatEps * oracle.range_m);
      }
      continue;
    }
    // They may differ only where the ray passes within 1 mm of an edge of what the one hit and the other missed.
    const bool embree_nearer = hit.hit() && !(oracle.range_m < hit.range_m);
    const std::uint32_t nearer = embree_nearer ? hit.triangle : oracle.triangle;
    const double range_m = embree_nearer ? hit.range_m : oracle.range_m;
    const Eigen::Vector3d point = r.origin + range_m * r.direction.cast<double>();
    EXPECT_LE(edge_distance(Triangle::of(scene.mesh(), nearer), point), 1e-3);
    ++at_edges;
  }
  EXPECT_GT(hits, 200);
  EXPECT_LE(at_edges, 4);
}

TEST(Trace, PacketsAreTheSameAsSingleRaysHoweverTheSpanIsCut) {
  const Scene scene(make_city(coarse_city()));
  const SceneAt at(scene);
  const std::vector<Ray> rays = city_rays(20011);  // no multiple of a packet
  std::vector<Hit> packets(rays.size()), pieces(rays.size());
  at.trace(rays, packets);
  for (std::size_t begin = 0; begin < rays.size(); begin += 37) {
    const std::size_t count = std::min<std::size_t>(37, rays.size() - begin);
    at.trace(std::span(rays).subspan(begin, count), std::span(pieces).subspan(begin, count));
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit single = at.trace(rays[i]);
    ASSERT_EQ(packets[i].triangle, single.triangle) << i;
    ASSERT_EQ(packets[i].range_m, single.range_m) << i;
    ASSERT_EQ(packets[i].normal, single.normal) << i;
    ASSERT_EQ(pieces[i].triangle, single.triangle) << i;
    ASSERT_EQ(pieces[i].range_m, single.range_m) << i;
  }
  at.trace(std::span<const Ray>{}, std::span<Hit>{});
}

TEST(Trace, PackedRaysMeetWhatSingleRaysMeet) {
  const Scene scene(make_city(coarse_city()));
  const SceneAt at(scene);
  const std::vector<Ray> rays = city_rays(160 * RayPacket::kRays);
  std::vector<RayPacket> packed(rays.size() / RayPacket::kRays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RayPacket& p = packed[i / RayPacket::kRays];
    const std::size_t lane = i % RayPacket::kRays;
    const Eigen::Vector3f origin = rays[i].origin.cast<float>();
    p.origin_x[lane] = origin.x(), p.origin_y[lane] = origin.y(), p.origin_z[lane] = origin.z();
    p.direction_x[lane] = rays[i].direction.x(), p.direction_y[lane] = rays[i].direction.y();
    p.direction_z[lane] = rays[i].direction.z();
    p.max_m[lane] = i % 7 == 0 ? -1.0f : 200.0f;  // every seventh is not traced
  }
  std::vector<HitPacket> hits(packed.size());
  at.trace(packed, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray r = rays[i];
    r.max_m = 200.0f;
    const Hit single = i % 7 == 0 ? Hit{} : SceneAt(scene).trace(r);
    const HitPacket& hit = hits[i / RayPacket::kRays];
    const std::size_t lane = i % RayPacket::kRays;
    ASSERT_EQ(hit.triangle[lane], single.triangle) << i;
    if (!single.hit()) {
      ASSERT_TRUE(std::isinf(hit.range_m[lane])) << i;
      continue;
    }
    ASSERT_EQ(hit.range_m[lane], single.range_m) << i;
    // Ours is rounded once; a product of the rounded normal three times more.
    ASSERT_NEAR(hit.cos_incidence[lane], std::abs(single.normal.dot(r.direction)), 2 * kFloatEps) << i;
  }
  packed[1].direction_y[3] = std::nanf("");
  EXPECT_THROW(at.trace(packed, hits), ProgramError);
}

TEST(Trace, IsTheSameFromManyThreads) {
  const Scene scene(make_city(coarse_city()));
  const SceneAt at(scene);
  const std::vector<Ray> rays = city_rays(4096);
  std::vector<Hit> serial(rays.size());
  at.trace(rays, serial);
  for (const int count : {1, 2, 8}) {
    set_threads(count);
    std::vector<Hit> parallel(rays.size());
    parallel_for(rays.size(), 256, [&](std::size_t begin, std::size_t end) {
      at.trace(std::span(rays).subspan(begin, end - begin), std::span(parallel).subspan(begin, end - begin));
    });
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(parallel[i].triangle, serial[i].triangle) << i << " with " << count << " threads";
      ASSERT_EQ(parallel[i].range_m, serial[i].range_m) << i << " with " << count << " threads";
    }
  }
  set_threads(0);
}

TEST(Trace, NotFiniteOrMismatchedQueriesThrow) {
  SceneParts parts = empty_parts();
  add_plane(parts, 1.0, 0.0);
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  EXPECT_THROW(at.trace(ray({0, 0, std::nan("")}, {0, 0, 1})), ProgramError);
  EXPECT_THROW(at.nearest({0, 0, std::nan("")}, 1.0), ProgramError);
  std::vector<Hit> hits(1);
  EXPECT_THROW(at.trace({}, hits), ProgramError);
}

TEST(Blocked, BothEndsAreKeptClear) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  add_building(parts, rectangle(10, -5, 12, 5), 0.0, 10.0);
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  EXPECT_TRUE(at.blocked({0, 0, 2}, {20, 0, 2}));
  EXPECT_FALSE(at.blocked({0, 0, 2}, {0, 20, 2}));
  EXPECT_FALSE(at.blocked({0, 0, 2}, {10, 0, 2})) << "a wall does not hide itself";
  EXPECT_FALSE(at.blocked({10, 0, 2}, {0, 0, 2}));
  EXPECT_FALSE(at.blocked({0, 0, 0}, {0, 0, 5})) << "nor does the ground";
  EXPECT_TRUE(at.blocked({0, 0, 2}, {10.01, 0, 2}));
  EXPECT_FALSE(at.blocked({0, 0, 2}, {0, 0, 2}));
}

// As satellites are seen from the street, with more rays than chance would give past the roofs' edges.
TEST(Blocked, AgreesWithTheDoublePrecisionOracle) {
  const Scene scene(make_city(coarse_city()));
  const SceneAt at(scene);
  const RandomStream random(5, "test.sky");
  int blocked = 0, at_edges = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const Building& building = scene.buildings()[i % scene.buildings().size()];
    const double x = building.footprint_W[0].x() + random.uniform(-60, 60, 0, i);
    const double y = building.footprint_W[0].y() + random.uniform(-60, 60, 1, i);
    const auto ground = scene.ground(x, y);
    if (!ground) continue;
    const Eigen::Vector3d p(x, y, ground->height_m + 1.5);
    Eigen::Vector3d towards(building.footprint_W[0].x(), building.footprint_W[0].y(), 0.0);
    towards.z() = building.base_m + building.height_m + (i % 2 == 0 ? 0.0 : random.uniform(-8, 8, 2, i));
    const Eigen::Vector3d direction = (towards - p).normalized();
    if (direction.z() < 0.05) continue;
    // Everything but trees, from 1 mm on.
    bool expected = false;
    double nearest_edge_m = 1e9;
    for (std::uint32_t k = 0; k < scene.mesh().triangles.size(); ++k) {
      if (scene.objects()[scene.mesh().object[k]].kind == ObjectKind::kTree) continue;
      const Triangle t = Triangle::of(scene.mesh(), k);
      const auto range = intersect(t, p, direction);
      if (range && *range > 1e-3) {
        expected = true;
        nearest_edge_m = std::min(nearest_edge_m, edge_distance(t, p + *range * direction));
      } else {
        // How near does the ray's crossing of the plane come to the triangle?
        const Eigen::Vector3d n = t.area_normal();
        const double range_m = n.dot(t.a - p) / n.dot(direction);
        if (range_m > 0.0 && range_m < 1e5)
          nearest_edge_m = std::min(nearest_edge_m, edge_distance(t, p + range_m * direction));
      }
    }
    const bool found = at.blocked_towards(p, direction);
    blocked += expected ? 1 : 0;
    if (found == expected) continue;
    EXPECT_LE(nearest_edge_m, 1e-3) << "ray " << i;
    ++at_edges;
  }
  EXPECT_GT(blocked, 100);
  EXPECT_LE(at_edges, 100) << "half of the rays go exactly past a corner";
}

TEST(Blocked, TreesAreLeftOutOnRequest) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  MeshBuilder mesh(parts);
  mesh.begin_object("tree 1", ObjectKind::kTree);
  mesh.box({5, 0, 2}, Eigen::Matrix3d::Identity(), {1, 1, 1}, mesh.material("foliage"));
  add_building(parts, rectangle(-12, -5, -10, 5), 0.0, 10.0);
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  const Eigen::Vector3d p(0, 0, 2), east(1, 0, 0), west(-1, 0, 0), down(0, 0, -1);
  EXPECT_FALSE(at.blocked_towards(p, east, 1e5, true));
  EXPECT_TRUE(at.blocked_towards(p, east, 1e5, false));
  EXPECT_FALSE(at.blocked_towards(p, east, 3.9, false));
  EXPECT_TRUE(at.blocked_towards(p, west, 1e5, true)) << "buildings block";
  EXPECT_FALSE(at.blocked_towards(p, west, 9.9, true));
  EXPECT_TRUE(at.blocked_towards(p, down, 1e5, true)) << "the ground blocks";
  EXPECT_TRUE(at.blocked({0, 0, 2}, {9, 0, 2})) << "segments meet trees";
  const Hit hit = at.trace(ray(p, east));
  EXPECT_EQ(hit.range_m, 4.0f);
  EXPECT_EQ(scene.objects()[scene.mesh().object[hit.triangle]].kind, ObjectKind::kTree);
}

TEST(Foliage, ChordsHaveTheClosedForm) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  parts.foliage.push_back({{10, 0, 5}, {2, 3, 4}});
  parts.foliage.push_back({{20, 0, 5}, {1, 1, 1}});
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  constexpr double kTolerance = 64 * 2.3e-16 * 20.0;  // n eps scale
  const Eigen::Vector3d east(1, 0, 0);
  EXPECT_NEAR(at.foliage_m({0, 0, 5}, east), 4.0 + 2.0, kTolerance);
  EXPECT_NEAR(at.foliage_m({0, 0, 5}, east, 15.0), 4.0, kTolerance) << "only up to max_m";
  EXPECT_NEAR(at.foliage_m({0, 0, 5}, east, 11.0), 3.0, kTolerance) << "ends inside a crown";
  EXPECT_NEAR(at.foliage_m({10, 0, 5}, east), 2.0 + 2.0, kTolerance) << "starts inside a crown";
  EXPECT_EQ(at.foliage_m({0, 0, 5}, -east), 0.0);
  EXPECT_NEAR(at.foliage_m({10, 1.5, -20}, {0, 0, 1}), 8.0 * std::sqrt(1.0 - 0.25), kTolerance);
  EXPECT_EQ(at.foliage_m({10, 3.0001, -20}, {0, 0, 1}), 0.0);
}

TEST(Nearest, AgreesWithTryingEveryTriangle) {
  const Scene scene(make_city(coarse_city()));
  const SceneAt at(scene);
  const RandomStream stream(3, "test.points");
  int found = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const double x = stream.uniform(-480, 480, 0, i), y = stream.uniform(-480, 480, 1, i);
    const Eigen::Vector3d p(x, y, scene.ground(x, y)->height_m + stream.uniform(-2, 8, 2, i));
    const double max_m = stream.uniform(0.5, 10.0, 3, i);
    NearestSurface best;
    for (std::uint32_t k = 0; k < scene.mesh().triangles.size(); ++k) {
      const Eigen::Vector3d q = Triangle::of(scene.mesh(), k).closest_point(p);
      if ((q - p).norm() < best.distance_m && (q - p).norm() <= max_m) best = {(q - p).norm(), q, k};
    }
    const NearestSurface nearest = at.nearest(p, max_m);
    EXPECT_EQ(nearest.triangle, best.triangle) << i;
    EXPECT_EQ(nearest.distance_m, best.distance_m) << i;
    if (best.triangle == Hit::kMiss) continue;
    EXPECT_EQ(nearest.point_W, best.point_W) << i;
    ++found;
  }
  EXPECT_GT(found, 100);
}

TEST(Nearest, FacesEdgesAndCornersOfABox) {
  SceneParts parts = empty_parts();
  MeshBuilder mesh(parts);
  mesh.begin_object("box", ObjectKind::kOther);
  mesh.box({0, 0, 0}, Eigen::Matrix3d::Identity(), {1, 2, 3}, 0);
  const Scene scene(std::move(parts));
  const SceneAt at(scene);
  constexpr double kTolerance = 16 * 2.3e-16 * 10.0;  // n eps scale
  const auto expect = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& on) {
    const NearestSurface nearest = at.nearest(p, 20.0);
    EXPECT_NEAR((nearest.point_W - on).norm(), 0.0, kTolerance);
    EXPECT_NEAR(nearest.distance_m, (p - on).norm(), kTolerance);
  };
  expect({4.125, 0.5, 0.25}, {1, 0.5, 0.25});
  expect({4, 5, 0.25}, {1, 2, 0.25});
  expect({4, 5, 9}, {1, 2, 3});
  expect({0.75, 0, 0}, {1, 0, 0});
  EXPECT_EQ(at.nearest({4.125, 0.5, 0.25}, 3.0).triangle, Hit::kMiss);
  EXPECT_EQ(at.nearest({4.125, 0.5, 0.25}, 3.125).distance_m, 3.125) << "a surface at exactly max_m counts";
}

}  // namespace
}  // namespace canyon::scene::testing
