// Scenes in tiles of any size, against every triangle: where the tiles lie, what rays meet, what is nearest.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"
#include "canyon/scene/tracing/tiled_tracer.h"

namespace canyon::scene {
namespace {

using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Looks;

/// Triangles of all sizes over a rectangle, ground among them, trees among what stands.
SceneParts strewn(std::uint64_t seed, const Eigen::Vector2d& low, const Eigen::Vector2d& high, int small, int large,
                  double large_m) {
  const RandomStream draws(seed, "stress.tiles");
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  const auto brick = mesh.material("brick");
  std::uint32_t n = 0;
  for (int k = 0; k < small + large; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const ObjectKind kind = k % 5 == 0 ? ObjectKind::kTree : k % 5 == 1 ? ObjectKind::kTerrain : ObjectKind::kBuilding;
    mesh.begin_object("thing " + std::to_string(++n), kind);
    const double size = k < small ? draws.uniform(5.0, 300.0, 0, i) : large_m;
    const Vector3d middle(draws.uniform(low.x(), high.x(), 1, i), draws.uniform(low.y(), high.y(), 2, i),
                          draws.uniform(0.0, 400.0, 3, i));
    Vector3d p[3];
    for (std::uint32_t c = 0; c < 3; ++c)
      p[c] = middle + size * Vector3d(draws.uniform(-1, 1, 4 + 3 * c, i), draws.uniform(-1, 1, 5 + 3 * c, i),
                                      0.3 * draws.uniform(-1, 1, 6 + 3 * c, i));
    for (Vector3d& corner : p)
      corner.head<2>() = corner.head<2>().cwiseMax(low).cwiseMin(high), corner.z() = std::min(corner.z(), 900.0);
    mesh.triangle(p[0], p[1], p[2], brick);
  }
  return parts;
}

/// As many tiles as their documentation says, about whole multiples of their edge, which is doubled until they are not
/// too many and triangles do not lie in too many of them; the middle of each place's own, or of the nearest.
StressFigure laid_out(std::uint64_t seed, const Eigen::Vector2d& low, const Eigen::Vector2d& high, int large,
                      double large_m) {
  Looks looks;
  const auto scene = made::scene_of(strewn(seed, low, high, 40, large, large_m));
  const TiledTracer tracer(scene->parts(), scene->extent());
  const Extent& extent = scene->extent();
  const auto number = [](double x, double edge) { return std::floor(x / edge + 0.5); };
  const Mesh& mesh = scene->mesh();
  double edge = 512.0, columns = 0.0, rows = 0.0;
  for (;; edge *= 2.0) {
    columns = number(extent.max.x(), edge) - number(extent.min.x(), edge) + 1.0;
    rows = number(extent.max.y(), edge) - number(extent.min.y(), edge) + 1.0;
    double shares = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle t = Triangle::of(mesh, i);
      const Vector3d a = t.a.cwiseMin(t.b).cwiseMin(t.c), b = t.a.cwiseMax(t.b).cwiseMax(t.c);
      shares += (number(b.x(), edge) - number(a.x(), edge) + 1.0) * (number(b.y(), edge) - number(a.y(), edge) + 1.0);
    }
    if (columns * rows <= 262144.0 && shares <= 4.0 * static_cast<double>(mesh.triangles.size()) + 1e6) break;
  }
  looks.near(static_cast<double>(tracer.tiles()), columns * rows, 1e-300);
  looks.right(tracer.tiles_made() == 0);
  const RandomStream draws(seed, "stress.places");
  for (std::uint64_t k = 0; k < 400; ++k) {
    const Vector3d p(draws.uniform(1.2 * low.x(), 1.2 * high.x(), 0, k),
                     draws.uniform(1.2 * low.y(), 1.2 * high.y(), 1, k), draws.uniform(-100, 100, 2, k));
    const Vector3d found = tracer.center(p);
    const auto nearest = [edge](double x, double from, double to) {
      const auto tile = [edge](double v) { return std::floor(v / edge + 0.5); };
      return edge * std::min(worse(tile(x), tile(from)), tile(to));
    };
    looks.near(found.x(), nearest(p.x(), extent.min.x(), extent.max.x()), 1e-6);
    looks.near(found.y(), nearest(p.y(), extent.min.y(), extent.max.y()), 1e-6);
    looks.near(found.z(), 0.0, 1e-300);
  }
  // A ray high above everything needs no tile, one down to the ground that of its place alone.
  looks.right(!tracer.trace(Ray{{low.x(), low.y(), 5000.0}, {0.6f, 0.8f, 0.0f}}).hit() && tracer.tiles_made() == 0);
  tracer.trace(Ray{0.5 * (extent.min + extent.max) + Vector3d(1.0, 2.0, 5000.0), {0.0f, 0.0f, -1.0f}});
  looks.right(tracer.tiles_made() <= 1);
  return looks.figure();
}

/// Rays from anywhere in a scene of tiles to anywhere, near and far, along its borders' directions too: range, triangle
/// and normal of the nearest of all, tried in turn; what lies between two ends, trees with it or not; the nearest
/// surface within reach, and the ground under a place. A plane's range is double precision rounded once, of a direction
/// that meets it at `approach`; what meets a triangle within a centimetre of a border is left out.
StressFigure like_every_triangle(std::uint64_t seed, double half_m) {
  Looks looks;
  const Eigen::Vector2d low(-half_m, -0.7 * half_m), high(1.1 * half_m, 0.9 * half_m);
  const auto scene = made::scene_of(strewn(seed, low, high, 500, 60, 0.4 * half_m));
  const SceneAt now(*scene);
  const Mesh& mesh = scene->mesh();
  const RandomStream draws(seed, "stress.rays");
  int met = 0, blocked = 0, trees_alone = 0, grounds = 0, near = 0, packed = 0;
  std::vector<Ray> rays;
  std::vector<Hit> singles;
  for (std::uint64_t k = 0; k < 500; ++k) {
    const Vector3d o(draws.uniform(1.1 * low.x(), 1.1 * high.x(), 0, k),
                     draws.uniform(1.1 * low.y(), 1.1 * high.y(), 1, k), draws.uniform(-50, 500, 2, k));
    Vector3d d = draws.direction(3, k);
    d.z() *= k % 3 == 0 ? 0.02 : 0.3;
    if (k % 11 == 0) d.x() = 0.0;
    if (k % 11 == 1) d.y() = 0.0;
    if (k % 11 == 2) d.x() = d.y() = 0.0;
    const auto most = static_cast<float>(k % 4 == 0 ? draws.uniform(100.0, 3000.0, 5, k) : 1e6);
    const Ray ray{o, d.normalized().cast<float>(), most};
    const made::BruteHit all = made::try_all(mesh, ray);
    const Hit hit = now.trace(ray);
    rays.push_back(ray), singles.push_back(hit);
    if (all.edge_m < 0.01 || std::abs(all.range_m - double{most}) < 0.01) continue;
    const bool within = all.range_m < double{most};
    looks.right(hit.hit() == within);
    if (within && hit.hit()) {
      looks.right(hit.triangle == all.triangle);
      looks.near(hit.range_m, all.range_m, 1.1 * kHalfUlp * all.range_m + 1e-9 * half_m / all.approach);
      const Triangle t = Triangle::of(mesh, all.triangle);
      const Vector3d normal = t.area_normal().normalized(), u = ray.direction.cast<double>();
      looks.near((hit.normal.cast<double>() + (normal.dot(u) > 0.0 ? 1.0 : -1.0) * normal).norm(), 0.0, 1e-5);
      ++met;
    }
    // Without trees: whether anything else lies on the way, from a millimetre on.
    bool solid = false, any = false, decided = true;
    const double length = draws.uniform(50.0, 1.5 * half_m, 6, k);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle t = Triangle::of(mesh, i);
      const Vector3d u = ray.direction.cast<double>(), e1 = t.b - t.a, e2 = t.c - t.a, q = u.cross(e2), s = o - t.a;
      const double det = e1.dot(q);
      if (det == 0.0) continue;
      const double b = s.dot(q) / det, c = u.dot(s.cross(e1)) / det, r = e2.dot(s.cross(e1)) / det;
      const double longest = worse(worse(e1.norm(), e2.norm()), (t.c - t.b).norm());
      const double margin = std::min({b, c, 1.0 - b - c}) * e1.cross(e2).norm() / longest;
      if (r < -1.0 || r > length + 1.0 || margin < -0.01) continue;
      if (margin < 0.01 || std::abs(r) < 1.0 || std::abs(r - length) < 1.0) decided = false;
      any = true;
      solid = solid || scene->objects()[mesh.object[i]].kind != ObjectKind::kTree;
    }
    if (decided) {
      looks.right(now.blocked_towards(o, ray.direction.cast<double>(), length, true) == solid);
      looks.right(now.blocked_towards(o, ray.direction.cast<double>(), length, false) == any);
      looks.right(now.blocked(o, o + length * ray.direction.cast<double>()) == any);
      blocked += solid ? 1 : 0, trees_alone += any && !solid ? 1 : 0;
    }
    // The nearest surface, of equally near ones the first.
    if (k % 4 == 1) {
      const double reach = draws.uniform(20.0, 900.0, 7, k);
      double least = kInfinity;
      std::uint32_t which = 0;
      for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const double away = (Triangle::of(mesh, i).closest_point(o) - o).norm();
        if (away < least) least = away, which = i;
      }
      const NearestSurface found = now.nearest(o, reach);
      if (std::abs(least - reach) > 1e-6) looks.right((found.triangle != Hit::kMiss) == (least < reach));
      if (found.triangle != Hit::kMiss) {
        looks.near(found.distance_m, least, 1e-9 * half_m), looks.right(found.triangle == which);
        looks.near((found.point_W - o).norm(), least, 1e-9 * half_m);
        ++near;
      }
    }
    // The highest ground under a place, whatever stands over it.
    double ground = -kInfinity, margin_m = kInfinity;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      if (scene->objects()[mesh.object[i]].kind != ObjectKind::kTerrain) continue;
      const Triangle t = Triangle::of(mesh, i);
      const Eigen::Vector2d a = t.a.head<2>(), e1 = t.b.head<2>() - a, e2 = t.c.head<2>() - a, q = o.head<2>() - a;
      const double det = e1.x() * e2.y() - e1.y() * e2.x();
      const double u = (q.x() * e2.y() - q.y() * e2.x()) / det, v = (e1.x() * q.y() - e1.y() * q.x()) / det;
      const double edge =
          std::min({u, v, 1.0 - u - v}) * std::abs(det) / worse(worse(e1.norm(), e2.norm()), (e2 - e1).norm());
      margin_m = std::min(margin_m, std::abs(edge));
      if (edge > 0.0) ground = worse(ground, t.a.z() + u * (t.b.z() - t.a.z()) + v * (t.c.z() - t.a.z()));
    }
    if (margin_m > 0.01) {
      const auto found = scene->ground(o.x(), o.y());
      looks.right(found.has_value() == (ground > -kInfinity));
      if (found && ground > -kInfinity) looks.near(found->height_m, ground, 1e-7 * half_m), ++grounds;
    }
  }
  // Many at once are what they are one by one.
  std::vector<Hit> together(rays.size());
  now.trace(rays, together);
  for (std::size_t k = 0; k < rays.size(); ++k)
    looks.right(together[k].triangle == singles[k].triangle && together[k].range_m == singles[k].range_m);
  // So are packets about any place of whole quarters, whose origins lie within a kilometre of it: to their own
  // rounding.
  for (std::uint64_t p = 0; p < 24; ++p) {
    const Vector3d about(std::round(draws.uniform(low.x(), high.x(), 20, p)) + 0.25,
                         std::round(draws.uniform(low.y(), high.y(), 21, p)), p % 2 == 0 ? 0.0 : 64.5);
    RayPacket packet{};
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const auto n = 16 * p + i;
      const Eigen::Vector3f o =
          Vector3d(draws.uniform(-1000, 1000, 22, n), draws.uniform(-1000, 1000, 23, n), draws.uniform(100, 300, 24, n))
              .cast<float>();
      Vector3d d = draws.direction(25, n);
      d.z() *= 0.3;
      const Eigen::Vector3f u = d.normalized().cast<float>();
      packet.origin_x[i] = o.x(), packet.origin_y[i] = o.y(), packet.origin_z[i] = o.z();
      packet.direction_x[i] = u.x(), packet.direction_y[i] = u.y(), packet.direction_z[i] = u.z();
      packet.max_m[i] = i == 3 ? -1.0f : 1e5f;
    }
    HitPacket hits;
    now.trace(std::span(&packet, 1), std::span(&hits, 1), about);
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      const Ray ray{about + Vector3d(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]),
                    {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]},
                    packet.max_m[i]};
      const Hit one = i == 3 ? Hit{} : now.trace(ray);
      looks.right((hits.triangle[i] != Hit::kMiss) == one.hit());
      if (hits.triangle[i] == Hit::kMiss || !one.hit()) continue;
      looks.right(hits.triangle[i] == one.triangle);
      const double approach = std::abs(one.normal.cast<double>().dot(ray.direction.cast<double>()));
      looks.near(hits.range_m[i], one.range_m, 2.0 * kHalfUlp * one.range_m + 1e-9 * half_m / approach);
      looks.near(hits.cos_incidence[i], approach, 8.0 * kHalfUlp);
      ++packed;
    }
  }
  looks.right(packed > 20);
  looks.right(met > 50 && blocked > 30 && trees_alone > 2 && grounds > 20 && near > 10);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> tile_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "tiles of scenes of every size",
           "a corner of the wrong half tile; columns counted as rows; edges that are doubled too often, or never",
           "as many as it takes, about whole multiples of their edge", "wrong"});
  rows.add("tiles/of_5_by_3_km",
           [] {
             return laid_out(1, {-2300, -1100}, {2900, 1900}, 0, 0.0);
           })
      .add("tiles/of_a_small_scene_far_away",
           [] {
             return laid_out(2, {7100, -300}, {7900, 500}, 0, 0.0);
           })
      .add("tiles/of_400_by_300_km",
           [] {
             return laid_out(3, {-1.5e5, -2e5}, {2.5e5, 1e5}, 0, 0.0);
           })
      .add("tiles/of_large_triangles", [] {
        return laid_out(4, {-6e4, -4e4}, {5e4, 7e4}, 120, 7e4);
      });
  rows.of({StressGroup::kGeometry, "rays, ways and places in a scene of tiles, or of none",
           "a tile left out or entered at the wrong border, a height that passes above what stands there",
           "every triangle tried in turn: double precision, rounded once", "of the bound"});
  for (const double half_m : {800.0, 3000.0, 20000.0})
    rows.add("tiles/like_every_triangle_within_" + stress::text(half_m) + "_m",
             [half_m] { return like_every_triangle(5, half_m); });
  return rows.take();
}

}  // namespace canyon::scene
