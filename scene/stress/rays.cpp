// Rays where a tracer in single precision may slip: through vertices and edges, grazing, from a surface, to nothing.
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using stress::kEpsilon;
using stress::kHalfUlp;
constexpr float kEndless = std::numeric_limits<float>::infinity();

/// A closed ball of n rings and 2 n meridians, radius 32 m, and where its vertices are.
std::unique_ptr<Scene> ball(int n) {
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  mesh.begin_object("ball", ObjectKind::kBuilding);
  const auto at = [&](int ring, int meridian) {
    if (ring == 0 || ring == n) return Eigen::Vector3d(0.0, 0.0, ring == 0 ? 32.0 : -32.0);
    const double a = kPi * ring / n, b = kPi * (meridian % (2 * n)) / n;
    return Eigen::Vector3d(32.0 * std::sin(a) * std::cos(b), 32.0 * std::sin(a) * std::sin(b), 32.0 * std::cos(a));
  };
  const auto brick = mesh.material("brick");
  for (int r = 0; r < n; ++r)
    for (int m = 0; m < 2 * n; ++m) {
      if (r > 0) mesh.triangle(at(r, m), at(r, m + 1), at(r + 1, m), brick);
      if (r + 1 < n) mesh.triangle(at(r, m + 1), at(r + 1, m + 1), at(r + 1, m), brick);
    }
  return made::scene_of(std::move(parts));
}

/// Rays from inside through every vertex, or through three places of every edge: how many leave the ball. Single and in
/// packets.
StressFigure leaks(int n, const Eigen::Vector3d& from, bool vertices) {
  const auto scene = ball(n);
  const SceneAt now(*scene);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < scene->mesh().triangles.size(); ++i) {
    const Triangle t = Triangle::of(scene->mesh(), i);
    std::vector<Eigen::Vector3d> through{t.a};
    if (!vertices) through = {0.5 * (t.a + t.b), 0.75 * t.b + 0.25 * t.c, 0.9375 * t.c + 0.0625 * t.a};
    for (const Eigen::Vector3d& p : through) rays.push_back({from, (p - from).normalized().cast<float>(), kEndless});
  }
  std::vector<Hit> hits(rays.size());
  now.trace(rays, hits);
  StressFigure out;
  for (std::size_t k = 0; k < rays.size(); ++k) out.figure += hits[k].hit() && now.trace(rays[k]).hit() ? 0.0 : 1.0;
  return out;
}

/// Random triangles of all sizes within 64 m; rays every way. Where no border of a crossed triangle is within 1 mm, the
/// same triangle, and its range in double precision, rounded once: half a unit of single precision, and what a plane's
/// rounding makes at that approach, 64 eps 128 m / approach.
StressFigure against_brute_force(std::uint64_t seed, int triangles, int rays) {
  const RandomStream draws(seed, "stress.rays");
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  mesh.begin_object("triangles", ObjectKind::kBuilding);
  std::uint64_t k = 0;
  const auto draw = [&](double low, double high) { return draws.uniform(low, high, 0, k++); };
  for (int i = 0; i < triangles; ++i) {
    const double size = std::pow(10.0, draw(-1.0, 1.5));
    Eigen::Vector3d p[3];
    const Eigen::Vector3d middle(draw(-32, 32), draw(-32, 32), draw(-32, 32));
    for (auto& corner : p) corner = middle + size * Eigen::Vector3d(draw(-1, 1), draw(-1, 1), draw(-1, 1));
    mesh.triangle(p[0], p[1], p[2], mesh.material("brick"));
  }
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out{0.0, 1.0};
  for (int i = 0; i < rays; ++i) {
    const Ray ray{{draw(-64, 64), draw(-64, 64), draw(-64, 64)},
                  Eigen::Vector3d(draw(-1, 1), draw(-1, 1), draw(-1, 1)).normalized().cast<float>(),
                  kEndless};
    const made::BruteHit exact = made::try_all(scene->mesh(), ray);
    if (exact.edge_m < 1e-3) continue;
    const Hit hit = now.trace(ray);
    if (hit.triangle != exact.triangle) return {std::numeric_limits<double>::infinity(), 1.0};
    if (!hit.hit()) continue;
    const double bound = 1.01 * kHalfUlp * exact.range_m + 64.0 * kEpsilon * 128.0 / exact.approach;
    take_worst(out, std::abs(hit.range_m - exact.range_m) / bound);
  }
  return out;
}

/// One level square, a ray that falls by `slope` from `height_m`: range = height / -direction.z, by the direction as it
/// is in single precision. Half a unit of the range.
StressFigure grazing(double height_m, double slope) {
  SceneParts parts = made::nothing();
  made::add_square(parts, Eigen::Vector3d::Zero(), 65536.0);
  const auto scene = made::scene_of(std::move(parts));
  StressFigure out{0.0, 1.01 * kHalfUlp};
  for (const double turn : {0.0, 0.3, 0.5 * kPi, 2.0, kPi}) {
    const Eigen::Vector3f d = Eigen::Vector3d(std::cos(turn), std::sin(turn), -slope).normalized().cast<float>();
    const Hit hit = SceneAt(*scene).trace({{-100.0, 37.0, height_m}, d, kEndless});
    const double exact = height_m / -static_cast<double>(d.z());
    take_worst(out, hit.hit() ? std::abs(hit.range_m / exact - 1.0) : std::numeric_limits<double>::quiet_NaN());
    if (hit.hit() && hit.normal.z() != 1.0f) out.figure = 1.0;
  }
  return out;
}

/// Rays within the plane of a wall, along its border and its diagonal, in all directions: a hit or none, but every
/// number finite and on the wall. A figure counts what is not.
StressFigure in_the_plane() {
  SceneParts parts = made::nothing();
  made::add_wall(parts, {8.0, 0.0, 0.0}, 4.0);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out;
  for (const double y : {-20.0, -4.0, 0.0, 4.0, 20.0})
    for (const double z : {-20.0, -4.0, 0.0, 4.0, 20.0})
      for (int k = 0; k < 64; ++k) {
        const double a = 2.0 * kPi * k / 64.0;
        const Ray ray{{8.0, y, z}, Eigen::Vector3d(0.0, std::cos(a), std::sin(a)).cast<float>(), kEndless};
        const Hit hit = now.trace(ray);
        if (!hit.hit()) continue;
        const Eigen::Vector3d p = ray.origin + hit.range_m * ray.direction.cast<double>();
        const bool on_it = std::isfinite(hit.range_m) && hit.range_m >= 0.0f && hit.normal.allFinite() &&
                           worse(std::abs(p.y()), std::abs(p.z())) <= 4.0 + 1e-3;
        out.figure += on_it ? 0.0 : 1.0;
      }
  return out;
}

/// A sensor in a wall, on it, and a rounding to either side: nothing is blocked by the wall it is in, whatever the way,
/// as 1 mm is kept clear; 2 mm away the wall is there. A figure counts what differs.
StressFigure in_a_wall() {
  SceneParts parts = made::nothing();
  made::add_wall(parts, {8.0, 0.0, 0.0}, 64.0);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out;
  const Eigen::Vector3d east = Eigen::Vector3d::UnitX();
  for (const double x : {8.0, std::nextafter(8.0, 0.0), std::nextafter(8.0, 9.0), 8.0 - 4e-7, 8.0 + 4e-7}) {
    const Eigen::Vector3d p(x, 0.25, -0.125);
    for (const double sense : {1.0, -1.0}) {
      out.figure += now.blocked_towards(p, sense * east) ? 1.0 : 0.0;
      out.figure += now.blocked(p, p + 5.0 * sense * east) || now.blocked(p + 5.0 * sense * east, p) ? 1.0 : 0.0;
    }
    const Hit hit = now.trace({p, east.cast<float>(), kEndless});
    out.figure += !hit.hit() || (std::isfinite(hit.range_m) && hit.range_m <= 1e-6f) ? 0.0 : 1.0;
  }
  for (const double off : {2e-3, 1.0}) {
    out.figure += now.blocked_towards({8.0 - off, 0.0, 0.0}, east) ? 0.0 : 1.0;
    out.figure += now.blocked_towards({8.0 - off, 0.0, 0.0}, -east) ? 1.0 : 0.0;
    out.figure += now.blocked({8.0 - off, 0.0, 0.0}, {8.0 + off, 0.0, 0.0}) ? 0.0 : 1.0;
  }
  out.figure += now.blocked({8.0, 0.0, 0.0}, {8.0, 0.0, 0.0}) ? 1.0 : 0.0;
  return out;
}

/// Two and a hundred walls in one plane: the range is that of one, half a unit; whichever is told.
StressFigure one_behind_another(int walls) {
  SceneParts parts = made::nothing();
  for (int k = 0; k < walls; ++k) made::add_wall(parts, {8.0, 0.0, 0.0}, 4.0 + 0.25 * (k % 3));
  const auto scene = made::scene_of(std::move(parts));
  StressFigure out{0.0, 1.01 * kHalfUlp};
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector3f d =
        Eigen::Vector3d(1.0, 0.4 * std::sin(k), 0.4 * std::cos(3.0 * k)).normalized().cast<float>();
    const Hit hit = SceneAt(*scene).trace({Eigen::Vector3d::Zero(), d, kEndless});
    take_worst(out, hit.hit() ? std::abs(hit.range_m * static_cast<double>(d.x()) / 8.0 - 1.0) : 1.0);
  }
  return out;
}

/// Directions with zeros of either sign, a reach of nothing, a reach that ends just before and just behind the wall.
StressFigure reaches() {
  SceneParts parts = made::nothing();
  made::add_wall(parts, {8.0, 0.0, 0.0}, 4.0);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  const Eigen::Vector3d o(0.0, 0.3, 0.7);
  StressFigure out;
  const auto expect = [&](bool met, const Ray& ray) { out.figure += now.trace(ray).hit() == met ? 0.0 : 1.0; };
  for (const float y : {0.0f, -0.0f})
    for (const float z : {0.0f, -0.0f})
      expect(true, {o, {1.0f, y, z}, kEndless}), expect(false, {o, {-1.0f, y, z}, kEndless});
  expect(false, {o, {1.0f, 0.0f, 0.0f}, 0.0f});
  expect(false, {o, {1.0f, 0.0f, 0.0f}, 7.9999f});
  expect(true, {o, {1.0f, 0.0f, 0.0f}, 8.0001f});
  expect(false, {o, {1.0f, 0.0f, 0.0f}, -1.0f});
  return out;
}

/// What is not finite is refused, single, in lists and in packets; a figure counts what was traced.
StressFigure not_finite() {
  SceneParts parts = made::nothing();
  made::add_wall(parts, {8.0, 0.0, 0.0}, 4.0);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  StressFigure out;
  const auto refused = [&](const auto& query) { out.figure += stress::not_refused(query); };
  // 1e30 is a number, but the ray tracer would end the process at it.
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e30})
    for (int field = 0; field < 6; ++field) {
      Ray ray{Eigen::Vector3d::Zero(), Eigen::Vector3f::UnitX(), kEndless};
      if (field < 3) ray.origin[field] = bad;
      if (field >= 3) ray.direction[field - 3] = static_cast<float>(bad);
      refused([&] { now.trace(ray); });
      refused([&] {
        const std::array<Ray, 1> rays{ray};
        std::array<Hit, 1> hits;
        now.trace(rays, hits);
      });
      refused([&] {
        RayPacket packet{};
        for (std::size_t i = 0; i < RayPacket::kRays; ++i) packet.direction_x[i] = 1.0f, packet.max_m[i] = 100.0f;
        packet.origin_x[7] = static_cast<float>(ray.origin.x()),
        packet.origin_y[7] = static_cast<float>(ray.origin.y());
        packet.origin_z[7] = static_cast<float>(ray.origin.z()), packet.direction_x[7] = ray.direction.x();
        packet.direction_y[7] = ray.direction.y(), packet.direction_z[7] = ray.direction.z();
        HitPacket hits;
        now.trace(std::span(&packet, 1), std::span(&hits, 1));
      });
      if (field < 3 && bad != 1e30) refused([&] { now.nearest(ray.origin, 10.0); });
      refused([&] { now.blocked_towards(ray.origin, ray.direction.cast<double>()); });
    }
  return out;
}

/// Ten million triangles of a plane that rises by 1/64 to the east: ranges by its closed form, half a unit.
StressFigure ten_million() {
  constexpr int kCells = 2240;
  SceneParts parts = made::nothing();
  const std::uint32_t object = MeshBuilder(parts).begin_object("terrain", ObjectKind::kTerrain);
  Mesh& mesh = parts.mesh;
  for (int r = 0; r <= kCells; ++r)
    for (int c = 0; c <= kCells; ++c) {
      const auto x = static_cast<float>(2 * c - kCells), y = static_cast<float>(2 * r - kCells);
      mesh.vertices.emplace_back(x, y, x / 64.0f);
    }
  const auto at = [](int c, int r) { return static_cast<std::uint32_t>(r * (kCells + 1) + c); };
  for (int r = 0; r < kCells; ++r)
    for (int c = 0; c < kCells; ++c) {
      mesh.triangles.push_back({at(c, r), at(c + 1, r), at(c + 1, r + 1)});
      mesh.triangles.push_back({at(c, r), at(c + 1, r + 1), at(c, r + 1)});
    }
  mesh.material.assign(mesh.triangles.size(), 0);
  mesh.object.assign(mesh.triangles.size(), object);
  const auto scene = made::scene_of(std::move(parts));
  const SceneAt now(*scene);
  const RandomStream draws(5, "stress.ten_million");
  StressFigure out{0.0, 1.01 * kHalfUlp + 64.0 * kEpsilon};
  for (std::uint64_t k = 0; k < 100000; ++k) {
    const Eigen::Vector3d o(draws.uniform(-1800, 1800, 0, k), draws.uniform(-1800, 1800, 1, k), 60.0);
    const double a = draws.uniform(0.0, 2.0 * kPi, 2, k), fall = draws.uniform(0.3, 3.0, 3, k);
    const Eigen::Vector3f d = Eigen::Vector3d(std::cos(a), std::sin(a), -fall).normalized().cast<float>();
    const double exact = (o.z() - o.x() / 64.0) / (static_cast<double>(d.x()) / 64.0 - static_cast<double>(d.z()));
    const Hit hit = now.trace({o, d, kEndless});
    take_worst(out, hit.hit() ? std::abs(hit.range_m / exact - 1.0) : 1.0);
  }
  return out;
}

}  // namespace

std::vector<StressCase> ray_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "rays through vertices and along edges of a closed surface",
           "three edge tests that each round another way leave gaps: a beam goes through a wall",
           "none leaves the ball", "leaks"});
  rows.add("rays/ball_edges_from_its_middle", [] { return leaks(24, Eigen::Vector3d::Zero(), false); })
      .add("rays/ball_edges_from_beside_its_middle",
           [] {
             return leaks(24, {7.0, -11.0, 3.0}, false);
           })
      .add("rays/ball_edges_from_near_its_wall",
           [] {
             return leaks(16, {31.0, 0.0, 2.0}, false);
           })
      .add("rays/ball_vertices_from_its_middle", [] { return leaks(24, Eigen::Vector3d::Zero(), true); })
      .add("rays/ball_vertices_from_beside_its_middle",
           [] {
             return leaks(24, {7.0, -11.0, 3.0}, true);
           })
      .open(
          "needs another ray tracer than Embree 3.13, whose robust test is watertight along edges alone: of rays "
          "exactly "
          "through a vertex one in a thousand slips between its triangles");
  rows.of({StressGroup::kGeometry, "ranges at the border of single precision",
           "a range computed in single precision: 20 um at 100 m, more where the ray grazes",
           "brute force in double precision, rounded once: half a unit, and 64 eps 128 m / approach", "of the bound"});
  rows.add("rays/one_triangle", [] { return against_brute_force(3, 1, 20000); }).add("rays/500_triangles", [] {
    return against_brute_force(1, 500, 4000);
  });
  rows.of({StressGroup::kGeometry, "grazing rays over level ground",
           "the range is a quotient of two small numbers; tiles and slabs are left and entered in single precision",
           "height / -direction.z to half a unit; the normal to the bit", ""});
  struct Grazing {
    double h, s;
    const char* name;
  };
  for (const Grazing& g : {Grazing{2.0, 1.0, "45_deg"}, Grazing{2.0, 1e-2, "10_mrad"}, Grazing{2.0, 1e-4, "100_urad"},
                           Grazing{0.0625, 2e-6, "2_urad"}, Grazing{0.001, 1e-7, "100_nrad"}})
    rows.add(std::string("rays/grazing_") + g.name, [g] { return grazing(g.h, g.s); });
  rows.of({StressGroup::kGeometry, "rays within the plane of a triangle", "0 / 0 of range and barycentric coordinates",
           "a hit on it or none, each number finite", "wrong"});
  rows.add("rays/in_the_plane_of_a_wall", in_the_plane);
  rows.of({StressGroup::kGeometry, "a sensor in or on a wall",
           "the surface that a ray starts from blocks it, by rounding",
           "1 mm is kept clear either way; 2 mm away the wall blocks", "wrong"});
  rows.add("rays/sensor_in_a_wall", in_a_wall);
  rows.of({StressGroup::kGeometry, "coplanar triangles, one behind another", "the order of equals decides on the range",
           "the one plane's range to half a unit", ""});
  rows.add("rays/two_walls_in_one_plane", [] { return one_behind_another(2); }).add("rays/100_walls_in_one_plane", [] {
    return one_behind_another(100);
  });
  rows.of({StressGroup::kGeometry, "zeros of either sign and reaches that just do", "1 / -0 turns a slab inside out",
           "as the wall at 8 m says", "wrong"});
  rows.add("rays/zeros_and_reaches", reaches);
  rows.of({StressGroup::kData, "a ray that is not finite, or beyond all places",
           "NaN bounds make a tree be walked whole, or not at all; from 1.8e18 m on Embree ends the process",
           "refused, single, in lists and packets, field by field", "traced"});
  rows.add("rays/not_finite_field_by_field", not_finite);
  rows.of({StressGroup::kLong, "ten million triangles", "counts of triangles beyond a type, tiles never made",
           "the plane's range to half a unit, 100,000 rays", ""});
  rows.add("rays/ten_million_triangles", ten_million).long_running();
  return rows.take();
}

}  // namespace canyon::scene
