// The vehicle's body against triangles and the things of a scene, by dense samples and in closed form.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/mission/collision/body_box.h"
#include "canyon/mission/collision/collision.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/mission/scoring/encounters.h"
#include "canyon/mission/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::mission {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::text;

/// From a point to the box: exact, axis by axis.
double point_to_box_m(const OrientedBox& box, const Vector3d& p_W) {
  const Vector3d p = box.X_WC.inverse() * p_W;
  return (p.cwiseAbs() - box.half_m).cwiseMax(0.0).norm();
}

/// Boxes and triangles of any size in any place: their distance is no larger than that of any of the triangle's
/// samples, and no smaller than the nearest one's less half their spacing, and they touch where it is nothing, beyond
/// that spacing. Rounding of coordinates `far_m` away comes on top.
StressFigure box_and_triangle(double size_m, double far_m) {
  const RandomStream draw(11, "stress.collisions");
  constexpr int kParts = 60;
  StressFigure out{0.0, 1.0};
  for (std::uint64_t k = 0; k < 150; ++k) {
    const auto vector = [&](std::uint64_t n, double most) {
      return Vector3d(draw.uniform(-most, most, n, k), draw.uniform(-most, most, n + 1, k),
                      draw.uniform(-most, most, n + 2, k));
    };
    const Vector3d place(far_m, -far_m, 0.5 * far_m);
    const OrientedBox box{
        {Eigen::Quaterniond(Eigen::AngleAxisd(draw.uniform(-3, 3, 0, k), vector(1, 1.0).normalized())),
         place + vector(4, 1.0)},
        {2.2, 0.9, 0.75}};
    const scene::Triangle triangle{place + vector(7, 4.0) + vector(10, size_m),
                                   place + vector(7, 4.0) + vector(13, size_m),
                                   place + vector(7, 4.0) + vector(16, size_m)};
    double sampled_m = kInfinity;
    for (int i = 0; i <= kParts; ++i)
      for (int j = 0; i + j <= kParts; ++j)
        sampled_m = std::min(sampled_m, point_to_box_m(box, triangle.a + (triangle.b - triangle.a) * i / kParts +
                                                                (triangle.c - triangle.a) * j / kParts));
    const double edge_m = worse(worse((triangle.b - triangle.a).norm(), (triangle.c - triangle.a).norm()),
                                (triangle.c - triangle.b).norm());
    const double spacing_m = edge_m / kParts, grain_m = 64.0 * kEpsilon * (far_m + 10.0),
                 found_m = distance_m(box, triangle);
    take_worst(out, beyond(found_m, sampled_m + grain_m) * 1e9);
    take_worst(out, beyond(sampled_m - spacing_m - grain_m, found_m) * 1e9);
    const bool touches = touch(box, triangle);
    if (sampled_m == 0.0) take_worst(out, touches && found_m == 0.0 ? 0.0 : 1e9);
    if (sampled_m > spacing_m + grain_m) take_worst(out, touches || found_m == 0.0 ? 1e9 : 0.0);
  }
  return out;
}

/// Level ground, a wall 2 m high along the way and, if `ahead_m` is not none, one across it.
scene::Scene lane(double beside_m, double ahead_m) {
  scene::SceneParts parts;
  parts.name = "lane";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-200, -200, 0}, {200, -200, 0}, {200, 200, 0}, {-200, 200, 0}, mesh.material("asphalt"));
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.quad({-100, beside_m, 0}, {100, beside_m, 0}, {100, beside_m, 2}, {-100, beside_m, 2},
            mesh.material("concrete"));
  if (ahead_m < kInfinity) {
    mesh.begin_object("barrier", scene::ObjectKind::kWall);
    mesh.quad({ahead_m, -5, 0}, {ahead_m, 5, 0}, {ahead_m, 5, 2}, {ahead_m, -5, 2}, mesh.material("concrete"));
  }
  return scene::Scene(std::move(parts));
}

KinematicState driving(double x_m, double speed_m_s) {
  KinematicState out;
  out.t = GpsTime::from_week_sow(2000, 1000.0 + x_m / speed_m_s);
  out.X_WB.p = {x_m, 0.0, 0.0};
  out.v_WB_W = {speed_m_s, 0.0, 0.0};
  return out;
}

/// By a wall that stands `beside_m` from the middle of the body: the least clearance is that less half the width, in
/// single precision of the wall's corners; below what counts as near it is one near miss, however long.
StressFigure along_a_wall(double clear_m) {
  const VehicleConfig vehicle;
  const SuccessConfig config;
  const scene::Scene scene = lane(0.5 * vehicle.width_m + clear_m, kInfinity);
  const scene::SceneAt at(scene);
  Encounters encounters(config, vehicle, at);
  for (double x = -40.0; x <= 40.0; x += 0.1)
    encounters.look(driving(x, 5.0), 5.0, {.speed_m_s = 5.0}, AutonomyState::kDriving);
  const auto numbers = encounters.numbers();
  StressFigure out{0.0, 1.0};
  take_worst(out, std::abs(numbers.clearance_min_m - std::min(clear_m, Encounters::kFar_m)) / 1e-6);
  take_worst(out, numbers.near_misses == (clear_m < config.near_miss_m ? 1 : 0) ? 0.0 : 1e9);
  take_worst(out, numbers.missed_obstacles == 0 && numbers.phantoms == 0 ? 0.0 : 1e9);
  return out;
}

/// Towards a barrier without slowing down: missed once it is nearer than v^2 / 2a; who finds no way 30 m before it has
/// seen a phantom, and right in front of it has not. A figure counts what is otherwise.
StressFigure towards_a_barrier(double speed_m_s) {
  const VehicleConfig vehicle;
  const SuccessConfig config;
  const scene::Scene scene = lane(50.0, 60.0);
  const scene::SceneAt at(scene);
  const double stop_m = 0.5 * speed_m_s * speed_m_s / vehicle.max_deceleration_m_s2;
  const double nose_m = body_box(vehicle, {}).X_WC.p.x() + 0.5 * vehicle.length_m;
  StressFigure out;
  const auto missed = [&](double from_x_m, double to_x_m, double asked_m_s) {
    Encounters encounters(config, vehicle, at);
    for (double x = from_x_m; x <= to_x_m; x += 0.1)
      encounters.look(driving(x, speed_m_s), speed_m_s, {.speed_m_s = asked_m_s}, AutonomyState::kDriving);
    return encounters.numbers().missed_obstacles;
  };
  // Boxes are laid along the way 0.5 m apart.
  const double border_m = 60.0 - nose_m - stop_m;
  out.figure += missed(border_m - 20.0, border_m - 0.2, speed_m_s) == 0 ? 0.0 : 1.0;
  out.figure += missed(border_m - 20.0, border_m + 1.0, speed_m_s) == 1 ? 0.0 : 1.0;
  out.figure += missed(border_m - 20.0, border_m + 1.0, 0.5 * speed_m_s) == 0 ? 0.0 : 1.0;
  const auto phantoms = [&](double x_m) {
    Encounters encounters(config, vehicle, at);
    encounters.look(driving(x_m, speed_m_s), 0.0, {.speed_m_s = 0.0}, AutonomyState::kBlocked);
    return encounters.numbers().phantoms;
  };
  out.figure += phantoms(60.0 - nose_m - 30.0) == 1 ? 0.0 : 1.0;
  out.figure += phantoms(60.0 - nose_m - 1.0) == 0 ? 0.0 : 1.0;
  return out;
}

/// Every check finds a wall that the body reaches into by a centimetre, with any side, and none a centimetre before it.
StressFigure reach_into(const char* name) {
  const auto* row = find_model(collision_checks(), name);
  if (row == nullptr) return {kInfinity, 0.0};
  ModelParameters own;
  if (row->parameters != nullptr) row->parameters(own);
  const VehicleConfig vehicle;
  const double nose_m = body_box(vehicle, {}).X_WC.p.x() + 0.5 * vehicle.length_m;
  StressFigure out;
  for (const double in_m : {-0.01, 0.01}) {
    const scene::Scene beside = lane(0.5 * vehicle.width_m - in_m, kInfinity), ahead = lane(50.0, nose_m - in_m);
    const scene::SceneAt at_beside(beside), at_ahead(ahead);
    for (const scene::SceneAt* at : {&at_beside, &at_ahead}) {
      const auto check = row->make(own, vehicle, *at);
      out.figure += check->touched(driving(0.0, 1.0)).has_value() == (in_m > 0.0) ? 0.0 : 1.0;
    }
  }
  return out;
}

}  // namespace

std::vector<StressCase> collision_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a box and a triangle, from specks to plains, near and far",
           .why = "nine products of edges that may be parallel, or nothing",
           .expected = "their distance, within the spacing of 1900 samples of the triangle",
           .unit = ""});
  for (const double size_m : {1e-6, 0.3, 5.0, 300.0})
    for (const double far_m : {0.0, 1e5})
      rows.add("collisions/triangles_of_" + text(size_m) + "_m_at_" + text(far_m) + "_m",
               [size_m, far_m] { return box_and_triangle(size_m, far_m); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "the way along a wall",
           .why = "one near miss must not be as many as there are steps",
           .expected = "the clearance, and one near miss below the least",
           .unit = ""});
  for (const double clear_m : {0.05, 0.29, 0.31, 1.0, 2.9, 4.0})
    rows.add("collisions/along_a_wall_" + text(clear_m) + "_m", [clear_m] { return along_a_wall(clear_m); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a barrier that is nearer than the vehicle can stop",
           .why = "a way to stop grows with the square of the speed",
           .expected = "missed from v^2 / 2a on unless it slows down; a phantom where the way is free",
           .unit = ""});
  for (const double speed_m_s : {2.0, 5.0, 8.0})
    rows.add("collisions/barrier_at_" + text(speed_m_s) + "_m_s", [speed_m_s] { return towards_a_barrier(speed_m_s); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a body that reaches into a wall by a centimetre",
           .why = "a wall is thinner than anything",
           .expected = "touched, and not a centimetre before it",
           .unit = ""});
  for (const char* name : {"lines", "box"})
    rows.add(std::string("collisions/reach_by_") + name, [name] { return reach_into(name); });
  return rows.take();
}

}  // namespace canyon::mission
