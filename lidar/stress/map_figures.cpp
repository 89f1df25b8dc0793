// Figures of maps, trajectories and the room around a route, each against all points, poses and triangles in turn.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/motion/route_segment.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/clearance.h"
#include "canyon/lidar/files/map_cloud.h"
#include "canyon/lidar/map_quality/map_error.h"
#include "canyon/lidar/map_quality/map_report.h"
#include "canyon/lidar/map_quality/signed_distance.h"
#include "canyon/lidar/map_quality/trajectory_error.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// Ground, a house, a pitched roof, a ramp just flatter and one just steeper than 30 degrees, and a tree's level
/// leaves.
scene::Scene mixed_scene() {
  scene::SceneParts parts;
  parts.name = "mixed";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-60, -60, 0}, {60, -60, 0}, {60, 60, 1}, {-60, 60, 1}, mesh.material("asphalt"));
  mesh.begin_object("house", scene::ObjectKind::kBuilding);
  mesh.box({10, 8, 4}, rotation_from({.yaw_rad = 0.4, .pitch_rad = 0.0, .roll_rad = 0.0}).toRotationMatrix(), {6, 4, 5},
           mesh.material("brick"));
  mesh.begin_object("ramps", scene::ObjectKind::kOther);
  for (const double degrees : {29.0, 31.0}) {
    const double rise = 8.0 * std::tan(degrees * kDegree), x = degrees < 30.0 ? -30.0 : -45.0;
    mesh.quad({x, -20, 3}, {x + 8, -20, 3 + rise}, {x + 8, -8, 3 + rise}, {x, -8, 3}, mesh.material("metal"));
  }
  mesh.begin_object("tree", scene::ObjectKind::kTree);
  mesh.quad({-30, 20, 6}, {-20, 20, 6}, {-20, 30, 6}, {-30, 30, 6}, mesh.material("foliage"));
  return scene::Scene(std::move(parts));
}

/// A map of points anywhere near, on and far from surfaces: of every figure of its report the definition, point by
/// point; of materials, ranges and level ground each its own. Roundings of a sum of n terms wander: five times sqrt(n)
/// eps of 3 m.
StressFigure any_map(std::uint64_t seed, int n, double cap_m) {
  Looks looks;
  const scene::Scene scene = mixed_scene();
  const scene::SceneAt now(scene);
  const RandomStream draws(seed, "stress.maps");
  std::vector<Vector3f> points;
  MapTruth truth;
  const auto drawn = [&](std::uint32_t what, std::uint64_t k) {
    return Vector3d(draws.uniform(-50, 50, what, k), draws.uniform(-50, 50, what + 1, k),
                    draws.uniform(-2, 12, what + 2, k));
  };
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(n); ++k) {
    Vector3d p = drawn(0, k);
    const auto near = now.nearest(p, 100.0);
    // Some of them within a few centimetres of a surface.
    if (k % 3 != 0) p = near.point_W + std::pow(draws.uniform(4, k), 3) * 0.4 * draws.direction(5, k);
    points.push_back(p.cast<float>());
  }
  for (std::uint64_t k = 0; k < 150; ++k) {
    const Vector3d p =
        k % 2 == 0 ? points[k % points.size()].cast<double>() + 0.15 * draws.normal3(k, 3) : drawn(10, k);
    truth.points_W.push_back(p.cast<float>());
  }
  for (std::uint64_t k = 0; k < 4; ++k) truth.sensor_W.push_back((0.6 * drawn(20, k)).cast<float>());
  const MapReport found = report_map(points, scene, truth, cap_m, 1.0);
  const SignedDistance distance(scene);
  struct Sum {
    double n = 0, square = 0, up = 0, across = 0, signed_m = 0;
  };
  Sum all, level;
  std::map<std::string, Sum> of_material;
  std::array<Sum, 5> of_range;
  std::vector<double> sizes;
  std::array<double, 3> accurate{}, complete{};
  double capped = 0, with_capped = 0, level_up = 0, level_n = 0, level_square = 0;
  for (const Vector3f& point : points) {
    const Vector3d p = point.cast<double>();
    const SurfaceOffset o = distance.at(p, cap_m);
    const double size = o.found ? std::abs(o.distance_m) : cap_m;
    sizes.push_back(size), with_capped += size * size;
    for (std::size_t k = 0; k < 3; ++k) accurate[k] += o.found && size <= (k == 0 ? 0.05 : k == 1 ? 0.1 : 0.2) ? 1 : 0;
    if (!o.found) {
      capped += 1;
      continue;
    }
    const auto add = [&](Sum& s) {
      s.n += 1, s.square += size * size, s.up += o.offset_W.z() * o.offset_W.z();
      s.across += o.offset_W.head<2>().squaredNorm(), s.signed_m += o.distance_m;
    };
    add(all);
    add(of_material[scene.materials()[scene.mesh().material[o.triangle]].name]);
    double range = 200.0;
    for (const Vector3f& s : truth.sensor_W) range = std::min(range, (p - s.cast<double>()).norm());
    add(of_range[range < 10 ? 0 : range < 20 ? 1 : range < 30 ? 2 : range < 40 ? 3 : 4]);
    const bool tree = scene.objects()[scene.mesh().object[o.triangle]].kind == scene::ObjectKind::kTree;
    const Vector3d normal = scene::Triangle::of(scene.mesh(), o.triangle).area_normal().normalized();
    if (!tree && std::acos(std::abs(normal.z())) < 30.0 * kDegree)
      add(level), level_up += o.offset_W.z(), level_n += 1, level_square += o.offset_W.z() * o.offset_W.z();
  }
  const double count = n, grain = 5.0 * std::sqrt(count) * kEpsilon * 3.0;
  looks.right(found.points == n && static_cast<double>(found.capped_points) == capped && capped > 0 && level.n > 10);
  const auto alike = [&](const MapErrors& e, const Sum& s) {
    looks.right(static_cast<double>(e.points) == s.n);
    if (s.n == 0) {
      looks.right(std::isnan(e.rms_m) && std::isnan(e.signed_mean_m));
      return;
    }
    looks.near(e.rms_m, std::sqrt(s.square / s.n), grain), looks.near(e.up_rms_m, std::sqrt(s.up / s.n), grain);
    looks.near(e.across_rms_m, std::sqrt(s.across / s.n), grain), looks.near(e.signed_mean_m, s.signed_m / s.n, grain);
  };
  MapErrors without_capped = found.all;
  without_capped.rms_m = std::sqrt(all.square / all.n);
  alike(without_capped, all);
  looks.near(found.all.rms_m, std::sqrt(with_capped / count), grain);
  looks.near(found.level_up_rms_m, std::sqrt(level.up / level.n), grain);
  looks.right(found.by_material.size() == of_material.size() && found.by_range.size() == 5);
  for (const MapErrors& e : found.by_material) alike(e, of_material[e.name]);
  const char* spans[] = {"0 to 10 m", "10 to 20 m", "20 to 30 m", "30 to 40 m", "40 m and more"};
  for (std::size_t k = 0; k < 5 && k < found.by_range.size(); ++k)
    alike(found.by_range[k], of_range[k]), looks.right(found.by_range[k].name == spans[k]);
  std::sort(sizes.begin(), sizes.end());
  // The nearest rank: the first that 95 of a hundred do not exceed.
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * count - 1e-9)) - 1;
  looks.near(found.p95_m, sizes[rank], 64.0 * kEpsilon);
  double there = 0, back = 0;
  for (const double s : sizes) there += s / count;
  for (const Vector3f& t : truth.points_W) {
    double least = cap_m;
    for (const Vector3f& p : points) least = std::min(least, (t.cast<double>() - p.cast<double>()).norm());
    back += least / 150.0;
    for (std::size_t k = 0; k < 3; ++k) complete[k] += least <= (k == 0 ? 0.05 : k == 1 ? 0.1 : 0.2) ? 1 : 0;
  }
  looks.near(found.chamfer_m, there + back, grain), looks.right(found.true_points == 150);
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = accurate[k] / count, c = complete[k] / 150.0;
    looks.near(found.accuracy[k], a, 1e-14), looks.near(found.completeness[k], c, 1e-14);
    looks.near(found.f_score[k], a + c > 0 ? 2.0 * a * c / (a + c) : 0.0, 1e-14);
  }
  // What a run says of its map, of the same points.
  MapCloud cloud;
  for (const Vector3f& p : points) cloud.push_back({.p_W = p});
  const MapScore score = evaluate_map(cloud, now, cap_m);
  const MapQuality& q = score.quality;
  looks.near(q.map_error_rms_m, std::sqrt(with_capped / count), grain);
  looks.near(q.map_error_p95_m, sizes[rank], 1.01 * stress::kHalfUlp * sizes[rank]);
  looks.right(static_cast<double>(q.up_points) == level_n && static_cast<double>(q.capped_points) == capped);
  looks.near(q.map_error_up_mean_m, level_up / level_n, grain);
  looks.near(q.map_error_up_rms_m, std::sqrt(level_square / level_n), grain);
  return looks.figure();
}

/// An estimate that wanders: absolute errors of every pose, and relative ones from every pose to the first so far on
/// and less than twice as far, by their definitions; under each alignment no small turn or shift makes the sum of
/// squares less; poses beside the truth's time do not count. 64 eps of 180 m; of logarithms near no turn a millionth of
/// what they are.
StressFigure wandering(const std::string& alignment, std::uint64_t seed) {
  Looks looks;
  const RandomStream draws(seed, "stress.trajectories");
  Trajectory truth, estimate;
  const GpsTime start = GpsTime::from_week_sow(2000, 100.0);
  const auto true_pose = [](double t) {
    return Pose{so3_exp({0.02 * std::sin(t), 0.03 * t, 0.1 * t}),
                {20.0 * std::sin(0.1 * t), 3.0 * t, 2.0 * std::cos(0.2 * t)}};
  };
  for (int k = 0; k <= 600; ++k) truth.append({start + 0.1 * k, true_pose(0.1 * k)});
  const Pose whole{so3_exp({0.0, 0.0, 0.3}), {4.0, -7.0, 1.0}};
  for (int k = -10; k <= 320; ++k) {
    const auto i = static_cast<std::uint64_t>(k + 10);
    const double t = 0.2 * k;
    const Pose off{so3_exp(0.02 * draws.normal3(i)), 0.1 * draws.normal3(i, 1)};
    estimate.append({start + t, whole * true_pose(t < 0.0 ? 0.0 : t) * off});
  }
  const auto& row = model_row(trajectory_alignments(), alignment);
  const TrajectoryErrors found = trajectory_errors(truth, estimate, row.make);
  std::vector<Pose> a, b;
  std::vector<double> times;
  for (const StampedPose& pose : estimate.poses())
    if (pose.t - start >= -1e-9 && pose.t - start <= 60.0 + 1e-9) {
      a.push_back(*truth.at(pose.t)), b.push_back(pose.X_WB), times.push_back(pose.t - start);
    }
  const auto n = static_cast<double>(a.size());
  looks.right(found.poses == static_cast<std::int64_t>(a.size()) && found.alignment_determined);
  const auto squares = [&](const Pose& X) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (X * b[k].p - a[k].p).squaredNorm();
    return sum;
  };
  const Pose X = found.X_true_estimated;
  if (alignment == "none") looks.near(X.p.norm() + so3_log(X.R).norm(), 0.0, 1e-300);
  const double least = squares(X);
  for (int axis = 0; alignment != "none" && axis < 6; ++axis)
    for (const double side : {-1.0, 1.0}) {
      if (alignment == "yaw" && axis < 2) continue;
      Vector6d xi = Vector6d::Zero();
      // About the middle of what is compared, so that turns and shifts have nothing in common: any one is worse.
      xi[axis] = side * (axis < 3 ? 1e-4 : 1e-2);
      const Pose moved = Pose{so3_exp(xi.head<3>()), xi.tail<3>()} * X;
      looks.right(squares(moved) > least);
    }
  if (alignment == "yaw") looks.near(so3_log(X.R).head<2>().norm(), 0.0, 1e-9);
  std::vector<double> errors;
  double mean = 0, square = 0, turns = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    errors.push_back((X * b[k].p - a[k].p).norm());
    mean += errors.back() / n, square += errors.back() * errors.back() / n;
    turns += std::pow(so3_log(a[k].R.conjugate() * X.R * b[k].R).norm() / kDegree, 2) / n;
  }
  std::sort(errors.begin(), errors.end());
  const std::size_t half = errors.size() / 2;
  looks.near(found.ate_rms_m, std::sqrt(square), 64.0 * kEpsilon * 180.0),
      looks.near(found.ate_mean_m, mean, 64.0 * kEpsilon * 180.0);
  looks.near(found.ate_max_m, errors.back(), 64.0 * kEpsilon * 180.0),
      looks.near(found.rotation_rms_deg, std::sqrt(turns), 1e-8);
  looks.near(found.ate_median_m, errors.size() % 2 == 1 ? errors[half] : 0.5 * (errors[half - 1] + errors[half]),
             64.0 * kEpsilon * 180.0);
  std::vector<double> way{0.0};
  for (std::size_t k = 1; k < a.size(); ++k) way.push_back(way.back() + (a[k].p - a[k - 1].p).norm());
  const std::pair<const char*, double> stretches[] = {
      {"1 m", 1.0}, {"10 m", 10.0}, {"100 m", 100.0}, {"1 s", 1.0}, {"10 s", 10.0}};
  looks.right(found.relative.size() == 5);
  for (std::size_t r = 0; r < 5 && r < found.relative.size(); ++r) {
    const std::vector<double>& along = r < 3 ? way : times;
    double pairs = 0, m2 = 0, deg2 = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      std::size_t j = i;
      while (j < a.size() && along[j] - along[i] < stretches[r].second * (1.0 - 1e-9)) ++j;
      if (j == a.size() || along[j] - along[i] >= stretches[r].second * (2.0 - 1e-9)) continue;
      const Pose error = (a[i].inverse() * a[j]).inverse() * (b[i].inverse() * b[j]);
      pairs += 1, m2 += error.p.squaredNorm(), deg2 += std::pow(so3_log(error.R).norm() / kDegree, 2);
    }
    looks.right(found.relative[r].over == stretches[r].first && static_cast<double>(found.relative[r].pairs) == pairs);
    looks.near(found.relative[r].translation_rms_m, std::sqrt(m2 / pairs), 64.0 * kEpsilon * 180.0);
    looks.near(found.relative[r].rotation_rms_deg, std::sqrt(deg2 / pairs), 1e-8);
  }
  return looks.figure();
}

/// The room around pieces of a route: to the rectangles around triangles, crowns and ways of traffic, from every point
/// of the line, less half a step and the half width, or from the rectangle around the line, at most 30 m; and the
/// steepest ground within. Double precision.
StressFigure around_a_route(std::uint64_t seed) {
  Looks looks;
  const RandomStream draws(seed, "stress.clearance");
  scene::SceneParts parts;
  parts.name = "route";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  for (int i = -6; i < 6; ++i)
    for (int j = -6; j < 6; ++j) {
      const auto z = [&](int a, int b) {
        return 0.2 * draws.normal(0, static_cast<std::uint64_t>(100 * (a + 7) + b + 7));
      };
      mesh.quad({20.0 * i, 20.0 * j, z(i, j)}, {20.0 * i + 20, 20.0 * j, z(i + 1, j)},
                {20.0 * i + 20, 20.0 * j + 20, z(i + 1, j + 1)}, {20.0 * i, 20.0 * j + 20, z(i, j + 1)},
                mesh.material("asphalt"));
    }
  for (std::uint64_t k = 0; k < 12; ++k) {
    mesh.begin_object("thing " + std::to_string(k), scene::ObjectKind::kPole);
    const double x = draws.uniform(-90, 90, 1, k), y = draws.uniform(-90, 90, 2, k);
    mesh.triangle({x, y, 0}, {x + 3.0, y + 1.0, 2}, {x + 1.0, y + 4.0, 5}, mesh.material("metal"));
  }
  for (std::uint64_t k = 0; k < 3; ++k)
    parts.foliage.push_back({{draws.uniform(-90, 90, 3, k), draws.uniform(-90, 90, 4, k), 5.0}, {2.0, 3.5, 1.0}, 1.0});
  const scene::Scene scene(std::move(parts));
  const std::vector<scene::SweptRoom> moving{{{-50, 60}, {40, 75}, 2.5, 2.0}};
  std::vector<RouteSegment> route;
  for (std::uint64_t k = 0; k < 40; ++k) {
    RouteSegment s;
    const Vector2d at(draws.uniform(-80, 80, 5, k), draws.uniform(-80, 80, 6, k));
    const double turn = draws.uniform(-3, 3, 7, k), step = k % 5 == 0 ? 2.0 : draws.uniform(0.01, 0.2, 8, k);
    for (int i = 0; i < 6; ++i)
      s.points_W.emplace_back(at.x() + step * i * std::cos(turn + 0.05 * i),
                              at.y() + step * i * std::sin(turn + 0.05 * i), 0.0);
    s.half_width_m = draws.uniform(0.0, 2.0, 9, k);
    route.push_back(s);
  }
  const auto found = clearances(scene, moving, route);
  looks.right(found.size() == route.size());
  int shut = 0, open = 0;
  for (std::size_t k = 0; k < route.size() && k < found.size(); ++k) {
    double step = 0.0;
    for (std::size_t i = 1; i < route[k].points_W.size(); ++i)
      step = worse(step, (route[k].points_W[i] - route[k].points_W[i - 1]).head<2>().norm());
    // From the line's points, less half a step; or from the rectangle around them, if nothing in there is nearer.
    Vector2d from = route[k].points_W[0].head<2>(), to = from;
    for (const Vector3d& p : route[k].points_W) from = from.cwiseMin(p.head<2>()), to = to.cwiseMax(p.head<2>());
    const auto apart = [&](const Vector2d& low, const Vector2d& high, bool least) {
      double nearest = kInfinity;
      for (const Vector3d& p : route[k].points_W)
        nearest = std::min(nearest, (low - p.head<2>()).cwiseMax(p.head<2>() - high).cwiseMax(0.0).norm());
      const double around = (low - to).cwiseMax(from - high).cwiseMax(0.0).norm();
      return (least ? nearest - 0.5 * step : worse(around, nearest - 0.5 * step)) - route[k].half_width_m;
    };
    const auto box = [&](std::uint32_t i) {
      const scene::Triangle t = scene::Triangle::of(scene.mesh(), i);
      return std::pair<Vector2d, Vector2d>(t.a.cwiseMin(t.b).cwiseMin(t.c).head<2>(),
                                           t.a.cwiseMax(t.b).cwiseMax(t.c).head<2>());
    };
    const auto is_ground = [&](std::uint32_t i) {
      return scene.objects()[scene.mesh().object[i]].kind == scene::ObjectKind::kTerrain;
    };
    double clear[2] = {30.0, 30.0}, slope[2] = {0.0, 0.0};
    for (const bool least : {true, false}) {
      double& c = clear[least ? 0 : 1];
      for (std::uint32_t i = 0; i < scene.mesh().triangles.size(); ++i)
        if (!is_ground(i)) c = std::min(c, apart(box(i).first, box(i).second, least));
      for (const scene::Foliage& f : scene.foliage()) {
        const Vector2d half(3.5, 3.5), at = f.center_W.head<2>();
        c = std::min(c, apart(at - half, at + half, least));
      }
      c = worse(0.0, std::min(c, apart({-52.5, 57.5}, {42.5, 77.5}, least)));
    }
    for (const bool least : {true, false})
      for (std::uint32_t i = 0; i < scene.mesh().triangles.size(); ++i) {
        const Vector3d n = scene::Triangle::of(scene.mesh(), i).area_normal();
        if (is_ground(i) && apart(box(i).first, box(i).second, least) <= found[k].clear_m + (least ? 1e-9 : -1e-9))
          slope[least ? 1 : 0] = worse(slope[least ? 1 : 0], n.head<2>().norm() / n.z());
      }
    looks.near(beyond(found[k].clear_m, clear[1]) + beyond(clear[0], found[k].clear_m), 0.0, 1e-12);
    looks.near(beyond(found[k].ground_slope, slope[1]) + beyond(slope[0], found[k].ground_slope), 0.0, 1e-12);
    (found[k].clear_m == 0.0 ? shut : open) += 1;
  }
  looks.right(shut > 1 && open > 5);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> map_figure_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "figures of any map, point by point",
           "a point counted with its neighbour's part, a rank off by one, a span of another border, a mean of squares",
           "definitions over all points: sums of so many terms", "of the bound"});
  for (const int n : {1000, 1013})
    for (const double cap_m : {1.0, 3.0})
      rows.add("map_figures/of_" + std::to_string(n) + "_points_capped_at_" + stress::text(cap_m) + "_m",
               [=] { return any_map(static_cast<std::uint64_t>(n), n, cap_m); });
  rows.of({StressGroup::kData, "a trajectory that wanders, pose by pose",
           "errors in the other frame, a stretch that ends a pose early, an alignment that is not the best",
           "definitions over all poses; no small move makes it better", "of the bound"});
  for (const auto& row : trajectory_alignments())
    rows.add(std::string("map_figures/wandering_aligned_by_") + row.name,
             [name = std::string(row.name)] { return wandering(name, 3); });
  rows.of({StressGroup::kGeometry, "the room around pieces of a route",
           "a half width that is added, ground as an obstacle", "all triangles, crowns and ways of traffic in turn",
           "of the bound"});
  for (const std::uint64_t seed : {1U, 2U})
    rows.add("map_figures/around_a_route_" + std::to_string(seed), [seed] { return around_a_route(seed); });
  return rows.take();
}

}  // namespace canyon::lidar
