#include "canyon/scene/tracing/tiled_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"
#include "canyon/tests/scene/small_scenes.h"

/// Scenes wider than 2 km: the same hits as without tiles, as exact far from W's origin as near it.
namespace canyon::scene::testing {
namespace {

/// Boxes turned every way on rolling ground, in a few places of a wide plain; a tower near the middle.
SceneParts wide_scene(double width_m, const std::vector<Eigen::Vector2d>& places) {
  const RandomStream stream(11, "test.wide");
  SceneParts parts = empty_parts();
  const double half_m = 0.5 * width_m;
  MeshBuilder mesh(parts);
  mesh.begin_object("terrain", ObjectKind::kTerrain);
  const int cells = 24;
  const auto ground = [&](int c, int r) {
    return Eigen::Vector3d(-half_m + c * width_m / cells, -half_m + r * width_m / cells, ((c * 7 + r * 3) % 5) * 3.0);
  };
  for (int r = 0; r < cells; ++r)
    for (int c = 0; c < cells; ++c)
      mesh.quad(ground(c, r), ground(c + 1, r), ground(c + 1, r + 1), ground(c, r + 1), mesh.material("asphalt"));
  std::uint32_t k = 0;
  for (const Eigen::Vector2d& place : places) {
    for (int i = 0; i < 60; ++i, ++k) {
      const Eigen::Vector3d at(place.x() + stream.uniform(-120, 120, 0, k), place.y() + stream.uniform(-120, 120, 1, k),
                               stream.uniform(5, 15, 2, k));
      const Eigen::Matrix3d turned =
          Eigen::AngleAxisd(stream.uniform(-kPi, kPi, 3, k), stream.direction(4, k)).toRotationMatrix();
      mesh.begin_object("box " + std::to_string(k), ObjectKind::kBuilding);
      mesh.box(at, turned, {stream.uniform(1, 8, 5, k), stream.uniform(1, 8, 6, k), stream.uniform(1, 8, 7, k)},
               mesh.material("concrete"));
    }
  }
  mesh.begin_object("tower", ObjectKind::kBuilding);
  mesh.box({30, 30, 200}, Eigen::Matrix3d::Identity(), {20, 20, 200}, mesh.material("concrete"));
  return parts;
}

/// Rays from one of the places; origins of 2^-10 m, which single precision holds about every center, or as they come.
std::vector<Ray> rays_from(const Eigen::Vector2d& place, std::size_t count, bool rounded) {
  const RandomStream stream(12, "test.wide_rays");
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i) {
    Eigen::Vector3d origin(place.x() + stream.uniform(-90, 90, 0, i), place.y() + stream.uniform(-90, 90, 1, i),
                           stream.uniform(16, 30, 2, i));
    if (rounded) origin = (origin * 1024.0).array().round().matrix() / 1024.0;
    Eigen::Vector3d direction = stream.direction(3, i);
    direction.z() = 0.4 * direction.z() - 0.25;
    rays.push_back({origin, direction.normalized().cast<float>(), 400.0f});
  }
  return rays;
}

/// Distance of a hit to the nearest edge of the triangle.
double to_edge_m(const Scene& scene, const Ray& ray, std::uint32_t triangle, double range_m) {
  return edge_distance(Triangle::of(scene.mesh(), triangle), ray.origin + range_m * ray.direction.cast<double>());
}

struct Difference {
  double median_m, p999_m;
  int hits, at_edges;
};

/// Ranges from a place against the oracle, which tries every triangle in double precision.
Difference against_the_oracle(double width_m, const Eigen::Vector2d& place) {
  const Scene scene(wide_scene(width_m, {place}));
  const SceneAt at(scene);
  std::vector<double> off_m;
  int at_edges = 0;
  for (const Ray& ray : rays_from(place, 6000, false)) {
    const Hit hit = at.trace(ray);
    const OracleHit oracle = trace_all(scene.mesh(), ray);
    if (hit.triangle != oracle.triangle) {
      const bool nearer = hit.hit() && !(oracle.range_m < hit.range_m);
      EXPECT_LE(to_edge_m(scene, ray, nearer ? hit.triangle : oracle.triangle, nearer ? hit.range_m : oracle.range_m),
                1e-3);
      ++at_edges;
    } else if (hit.hit()) {
      off_m.push_back(std::abs(hit.range_m - oracle.range_m));
    }
  }
  std::sort(off_m.begin(), off_m.end());
  const Difference out{off_m[off_m.size() / 2], off_m[off_m.size() * 999 / 1000], static_cast<int>(off_m.size()),
                       at_edges};
  std::printf("  %.0f km wide, %.0f m from the origin: median %.2g m, 99.9 %% %.2g m, %d hits, %d at edges\n",
              width_m / 1e3, place.norm(), out.median_m, out.p999_m, out.hits, out.at_edges);
  return out;
}

// The range is computed in double precision and rounded once: half a step of single precision at 128 to 400 m is 8 to
// 15 um, at 50 m 2 um.
TEST(TiledTracer, AsExactFarFromTheOriginAsNear) {
  for (const auto& [width_m, place] :
       {std::pair{1000.0, Eigen::Vector2d(0, 0)}, std::pair{5000.0, Eigen::Vector2d(2350, -2200)},
        std::pair{20000.0, Eigen::Vector2d(-9800, 9700)}}) {
    const Difference d = against_the_oracle(width_m, place);
    EXPECT_LT(d.median_m, 3e-6);
    EXPECT_LT(d.p999_m, 1.6e-5);
    EXPECT_GT(d.hits, 3000);
    EXPECT_LE(d.at_edges, 6);
  }
}

TEST(TiledTracer, PacketsFarFromTheOriginAreExactToTheirRounding) {
  const Eigen::Vector2d place(-9800, 9700);
  const Scene scene(wide_scene(20000.0, {place}));
  const SceneAt at(scene);
  const Eigen::Vector3d middle(place.x(), place.y(), 0.0), origin_W = at.packet_origin(middle);
  EXPECT_LE((origin_W - middle).cwiseAbs().head<2>().maxCoeff(), 256.0);
  std::vector<Ray> rays = rays_from(place, 300 * RayPacket::kRays, false);
  std::vector<RayPacket> packets(300), in_W(300);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t lane = i % RayPacket::kRays;
    for (auto* p : {&packets[i / RayPacket::kRays], &in_W[i / RayPacket::kRays]}) {
      const Eigen::Vector3d o = rays[i].origin - (p == &packets[i / RayPacket::kRays] ? origin_W : 0.0 * origin_W);
      p->origin_x[lane] = static_cast<float>(o.x()), p->origin_y[lane] = static_cast<float>(o.y());
      p->origin_z[lane] = static_cast<float>(o.z());
      p->direction_x[lane] = rays[i].direction.x(), p->direction_y[lane] = rays[i].direction.y();
      p->direction_z[lane] = rays[i].direction.z();
      p->max_m[lane] = i % 5 == 0 ? -1.0f : rays[i].max_m;
    }
  }
  std::vector<HitPacket> about_tile(300), about_W(300);
  at.trace(packets, about_tile, origin_W);
  at.trace(in_W, about_W);
  std::vector<double> off_m, off_in_W_m;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t lane = i % RayPacket::kRays;
    const HitPacket &near = about_tile[i / RayPacket::kRays], &far = about_W[i / RayPacket::kRays];
    if (i % 5 == 0) {
      EXPECT_EQ(near.triangle[lane], Hit::kMiss);
      EXPECT_EQ(far.triangle[lane], Hit::kMiss);
      continue;
    }
    const Hit single = at.trace(rays[i]);
    if (!single.hit()) continue;
    const double cosine = std::max(0.02, double{std::abs(single.normal.dot(rays[i].direction))});
    if (near.triangle[lane] == single.triangle) {
      off_m.push_back(std::abs(near.range_m[lane] - single.range_m));
      // Origins within 256 m of the tile's center are rounded by 8 um in each axis, by 15 um at most beyond.
      EXPECT_LE(off_m.back(), std::sqrt(3.0) * 1.6e-5 / cosine + 3.1e-5) << i;
      EXPECT_NEAR(near.cos_incidence[lane], std::abs(single.normal.dot(rays[i].direction)), 1e-6);
    } else {
      EXPECT_LE(to_edge_m(scene, rays[i], single.triangle, single.range_m), 1e-3);
    }
    if (far.triangle[lane] == single.triangle) off_in_W_m.push_back(std::abs(far.range_m[lane] - single.range_m));
  }
  std::sort(off_m.begin(), off_m.end());
  std::sort(off_in_W_m.begin(), off_in_W_m.end());
  ASSERT_GT(off_m.size(), 2000u);
  std::printf("  origins about the tile: median %.2g m, 99.9 %% %.2g m; about W's origin: %.2g m, %.2g m\n",
              off_m[off_m.size() / 2], off_m[off_m.size() * 999 / 1000], off_in_W_m[off_in_W_m.size() / 2],
              off_in_W_m[off_in_W_m.size() * 999 / 1000]);
}

TEST(TiledTracer, HitsAreThoseOfTheWholeScene) {
  const std::vector<Eigen::Vector2d> places = {{2350, -2200}, {0, 0}, {-1790, 256}};
  const Scene scene(wide_scene(5000.0, places));
  const SceneAt at(scene);
  std::vector<std::uint32_t> all(scene.mesh().triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  const Tracer whole(scene.parts(), all, Eigen::Vector3d::Zero());
  int far = 0, at_edges = 0;
  for (const Eigen::Vector2d& place : places) {
    std::vector<Ray> rays = rays_from(place, 4000, true);
    for (std::size_t i = 0; i < rays.size(); i += 2) rays[i].max_m = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < rays.size(); i += 4) rays[i].direction.z() = -0.02f;
    for (Ray& ray : rays) ray.direction.normalize();
    std::vector<Hit> many(rays.size());
    at.trace(rays, many);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit tiled = at.trace(rays[i]), plain = whole.trace(rays[i], {0.0, rays[i].max_m});
      ASSERT_EQ(many[i].triangle, tiled.triangle) << i;
      ASSERT_EQ(many[i].range_m, tiled.range_m) << i;
      if (tiled.triangle != plain.triangle) {
        const bool nearer = tiled.hit() && !(plain.hit() && plain.range_m < tiled.range_m);
        const Hit& one = nearer ? tiled : plain;
        EXPECT_LE(to_edge_m(scene, rays[i], one.triangle, one.range_m), 1e-3) << i;
        ++at_edges;
        continue;
      }
      if (!tiled.hit()) continue;
      ASSERT_EQ(tiled.range_m, plain.range_m) << i;  // to the bit
      ASSERT_EQ(tiled.normal, plain.normal) << i;
      far += tiled.range_m > TiledTracer::kTile_m;
    }
  }
  EXPECT_GT(far, 200);
  EXPECT_LE(at_edges, 3);
}

TEST(TiledTracer, AFarTowerHidesTheSky) {
  const Scene scene(wide_scene(5000.0, {{2350, -2200}}));
  const SceneAt at(scene);
  const Eigen::Vector3d p(-1970, 30, 40);  // the tower's wall is 1980 m to the east, 400 m high: 10.3 degrees
  const auto towards = [](double elevation_deg) {
    return Eigen::Vector3d(std::cos(elevation_deg * kDegree), 0, std::sin(elevation_deg * kDegree));
  };
  EXPECT_TRUE(at.blocked_towards(p, towards(10.2)));
  EXPECT_FALSE(at.blocked_towards(p, towards(10.4)));
  EXPECT_FALSE(at.blocked_towards(p, towards(10.2), 1990.0));
  EXPECT_TRUE(at.blocked_towards(p, towards(10.2), 2020.0));
  EXPECT_TRUE(at.blocked(p, {1000, 30, 40}));
  EXPECT_FALSE(at.blocked(p, {0, 30, 40}));
  EXPECT_NEAR(at.trace({p, {1, 0, 0}}).range_m, 1980.0, 1e-4);

  // Only what rays can meet is made: the tile at p, and the tower's.
  const TiledTracer tracer(scene.parts(), scene.extent());
  EXPECT_GT(tracer.tiles(), 100u);
  EXPECT_TRUE(tracer.occluded(p, towards(10.2).cast<float>(), 1e-3f, 1e5f, kTraceAll));
  EXPECT_FALSE(tracer.occluded(p, towards(60.0).cast<float>(), 1e-3f, 1e5f, kTraceAll));
  EXPECT_LE(tracer.tiles_made(), 3u);
}

TEST(TiledTracer, SweepsAcrossABorderAndPacketsAboutAnotherTileMeetTheSame) {
  const Eigen::Vector2d place(1280.0, 256.0);  // where four tiles meet
  const Scene scene(wide_scene(5000.0, {place}));
  const SceneAt at(scene);
  const std::vector<Ray> rays = rays_from(place, 100 * RayPacket::kRays, true);
  const auto trace_about = [&](const Eigen::Vector3d& origin_W) {
    std::vector<RayPacket> packets(100);
    std::vector<HitPacket> hits(100);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RayPacket& p = packets[i / RayPacket::kRays];
      const std::size_t lane = i % RayPacket::kRays;
      const Eigen::Vector3f o = (rays[i].origin - origin_W).cast<float>();  // exact: whole metres apart
      p.origin_x[lane] = o.x(), p.origin_y[lane] = o.y(), p.origin_z[lane] = o.z();
      p.direction_x[lane] = rays[i].direction.x(), p.direction_y[lane] = rays[i].direction.y();
      p.direction_z[lane] = rays[i].direction.z();
      p.max_m[lane] = rays[i].max_m;
    }
    at.trace(packets, hits, origin_W);
    return hits;
  };
  const auto first = trace_about({1024, 0, 0});
  for (const Eigen::Vector3d& origin_W : {Eigen::Vector3d(1536, 512, 0), Eigen::Vector3d(1000, 77, 5)}) {
    const auto other = trace_about(origin_W);
    int at_edges = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::size_t p = i / RayPacket::kRays, lane = i % RayPacket::kRays;
      if (first[p].triangle[lane] != other[p].triangle[lane]) {
        ++at_edges;
        continue;
      }
      if (first[p].triangle[lane] != Hit::kMiss) {
        EXPECT_EQ(first[p].range_m[lane], other[p].range_m[lane]) << i;
      }
    }
    EXPECT_LE(at_edges, 2);
  }
}

TEST(TiledTracer, IsTheSameFromManyThreads) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 6; ++i) places.emplace_back(-2300 + 900 * i, 2200 - 800 * i);
  const SceneParts parts = wide_scene(5000.0, places);
  std::vector<Ray> rays;
  for (const Eigen::Vector2d& place : places) {
    const auto some = rays_from(place, 600, true);
    rays.insert(rays.end(), some.begin(), some.end());
  }
  std::vector<Hit> serial(rays.size());
  {
    const Scene scene(parts);
    SceneAt(scene).trace(rays, serial);
  }
  for (const int count : {1, 2, 8}) {
    set_threads(count);
    const Scene scene(parts);  // tiles are made by whichever thread comes first
    const SceneAt at(scene);
    std::vector<Hit> parallel(rays.size());
    parallel_for(rays.size(), 32, [&](std::size_t begin, std::size_t end) {
      at.trace(std::span(rays).subspan(begin, end - begin), std::span(parallel).subspan(begin, end - begin));
    });
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(parallel[i].triangle, serial[i].triangle) << i << " with " << count << " threads";
      ASSERT_EQ(parallel[i].range_m, serial[i].range_m) << i << " with " << count << " threads";
    }
  }
  set_threads(0);
}

TEST(TiledTracer, MovingThingsFarFromTheOrigin) {
  const Scene scene(wide_scene(20000.0, {{0, 0}}));
  SceneAt at(scene);
  Mesh mesh;
  mesh.vertices = {{0, -2, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 1, 2}};
  mesh.material = {0};
  const auto shape = std::make_shared<RigidShape>("board", ObjectKind::kOther, mesh);
  const Eigen::Vector3d place(9000.12345, -8000.54321, 50.0);
  at.set_instances({{shape, "board", {Eigen::Quaterniond::Identity(), place}}});
  const Eigen::Vector3d p = place + Eigen::Vector3d(-25.0, 0.001, 1.0);
  EXPECT_NEAR(at.trace({p, {1, 0, 0}}).range_m, 25.0, 2e-6);
  RayPacket packet{};
  std::fill_n(packet.max_m, RayPacket::kRays, -1.0f);
  const Eigen::Vector3d origin_W = at.packet_origin(p), o = p - origin_W;
  packet.origin_x[3] = static_cast<float>(o.x()), packet.origin_y[3] = static_cast<float>(o.y());
  packet.origin_z[3] = static_cast<float>(o.z());
  packet.direction_x[3] = 1.0f, packet.max_m[3] = 100.0f;
  HitPacket hit;
  at.trace({&packet, 1}, {&hit, 1}, origin_W);
  EXPECT_NEAR(hit.range_m[3], 25.0, 1.6e-5);
  EXPECT_TRUE(at.blocked(p, p + Eigen::Vector3d(30, 0, 0)));
}

TEST(TiledTracer, NotFiniteThrows) {
  const Scene scene(wide_scene(5000.0, {{0, 0}}));
  const SceneAt at(scene);
  EXPECT_THROW(at.trace({{0, std::nan(""), 0}, {1, 0, 0}}), ProgramError);
  EXPECT_THROW(at.trace({{0, 0, 0}, {std::nanf(""), 0, 0}}), ProgramError);
  EXPECT_THROW(at.blocked({0, std::nan(""), 0}, {1, 0, 0}), ProgramError);
  RayPacket packet{};
  packet.origin_x[2] = std::nanf("");
  HitPacket hit;
  EXPECT_THROW(at.trace({&packet, 1}, {&hit, 1}), ProgramError);
}

// The searches look at tiles first; what they find is what looking at each facet and edge finds.
TEST(WideScene, MirrorsAndShadingEdgesAreFoundFromAnyDistance) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 5; ++i) places.emplace_back(-3800 + 1900 * i, 3600 - 1800 * i);
  const Scene scene(wide_scene(8000.0, places));
  std::vector<std::uint32_t> found;
  std::size_t mirrors = 0, edges = 0;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(-3800, 3600, 2), Eigen::Vector3d(500, -700, 30)}) {
    for (const double elevation : {5.0 * kDegree, 25.0 * kDegree}) {
      scene.facets().mirrors(p, elevation, 8.0, 1e9, found);
      mirrors += found.size();
      std::sort(found.begin(), found.end());
      for (std::uint32_t i = 0; i < scene.facets().facets().size(); ++i) {
        const FacetIndex alone({scene.facets().facets()[i]});
        std::vector<std::uint32_t> one;
        alone.mirrors(p, elevation, 8.0, 1e9, one);
        const bool listed = std::binary_search(found.begin(), found.end(), i);
        EXPECT_EQ(listed, !one.empty()) << i;
      }
      scene.edges().shading(p, elevation, 0.3, found);
      edges += found.size();
      std::sort(found.begin(), found.end());
      for (std::uint32_t i = 0; i < scene.edges().edges().size(); ++i) {
        const EdgeIndex alone({scene.edges().edges()[i]});
        std::vector<std::uint32_t> one;
        alone.shading(p, elevation, 0.3, one);
        EXPECT_EQ(std::binary_search(found.begin(), found.end(), i), !one.empty()) << i;
      }
    }
  }
  EXPECT_GT(mirrors, 20u);
  EXPECT_GT(edges, 20u);
}

}  // namespace
}  // namespace canyon::scene::testing
