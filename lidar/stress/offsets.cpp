// Whole drives of a scanner, what a map of them ought to hold, and how far its points lie off the surfaces.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/map_quality/point_grid.h"
#include "canyon/lidar/map_quality/signed_distance.h"
#include "canyon/lidar/map_quality/true_points.h"
#include "canyon/lidar/map_quality/wall_thickness.h"
#include "canyon/lidar/scan_drive.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using stress::kHalfUlp;
using stress::Looks;

const Vector3d kHall(14.0, 9.0, 5.0);

scene::SceneParts hall_parts() {
  scene::SceneParts parts;
  parts.name = "hall";
  parts.materials = scene::builtin_materials();
  return parts;
}
std::shared_ptr<const scene::Scene> hall() {
  scene::SceneParts parts = hall_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("hall", scene::ObjectKind::kBuilding);
  mesh.box({0, 0, 0}, Eigen::Matrix3d::Identity(), kHall, mesh.material("concrete"));
  return std::make_shared<const scene::Scene>(std::move(parts));
}
double off_the_hall(const Vector3d& p) {
  return std::abs((p.cwiseAbs() - kHall).maxCoeff<Eigen::PropagateNaN>());
}

ScanDrive drive_in(std::shared_ptr<const scene::Scene> scene, const std::string& beams) {
  ScanDrive out;
  out.scene = std::move(scene);
  out.lidar.beams = beams;
  out.lidar.mount_m = Vector3d(0.3, -0.2, 0.9);
  out.lidar.azimuth_steps = 180;
  out.lidar.range_noise_m = 0.0;
  out.lidar.report.range_quantum_m = 0.0;
  out.lidar.report.min_range_m = 0.01;
  // Round a circle of 3 m, a turn in eight seconds, bobbing and swaying.
  const GpsTime begin = GpsTime::from_week_sow(2000, 100.0);
  for (int k = 0; k <= 400; ++k) {
    const double t = 0.005 * k, turn = 2.0 * kPi * t / 8.0;
    const Eigen::Quaterniond R = Eigen::Quaterniond(Eigen::AngleAxisd(turn, Vector3d::UnitZ())) *
                                 so3_exp(Vector3d(0.05 * std::sin(3.0 * t), 0.04 * std::cos(2.0 * t), 0.0));
    out.motion.append({begin + t, {R, Vector3d(3.0 * std::sin(turn), -3.0 * std::cos(turn), 0.1 * std::sin(4.0 * t))}});
  }
  out.cover_motion();
  return out;
}

/// Every point of every scan lies on a wall of the hall, in W, from where the sensor was when it fired: chords of 5 ms
/// of turns of 1 rad/s and of accelerations of 2 m/s^2 are below 1e-5 rad and m, over 17 m; single precision beside
/// them. As many scans, in their order and at their stamps, as the motion covers; a latency makes stamps later, no
/// more.
StressFigure walls_of_a_hall(const std::string& beams, double latency_s) {
  Looks looks;
  ScanDrive drive = drive_in(hall(), beams);
  drive.lidar.latency_s = latency_s;
  drive.cover_motion();
  const double covered_s = 2.0 - drive.before_s();
  looks.right(drive.scans == static_cast<std::int64_t>(std::floor(covered_s * drive.lidar.rate_hz + 1e-6)) + 1);
  std::int64_t next = 0, points = 0;
  const auto cost = scan_drive(drive, 3, [&](std::int64_t k, GpsTime t, const LidarOutput& out, const scene::SceneAt&) {
    looks.right(k == next++);
    looks.near(t - drive.start, static_cast<double>(k) / drive.lidar.rate_hz, 1e-8);
    looks.right(out.scan.t == t && out.truth.size() == out.scan.points.size() && out.scan.points.size() > 1500);
    points += static_cast<std::int64_t>(out.scan.points.size());
    for (const LidarPoint& p : points_in_scene(drive, out.scan))
      looks.near(off_the_hall(Vector3d(p.x, p.y, p.z)), 0.0, 17.0 * 1e-5 * 5.0 + 64.0 * kHalfUlp * 17.0);
    return Status(Ok{});
  });
  looks.right(cost.ok() && next == drive.scans);
  if (cost) looks.right(cost->points == points && cost->rays >= points);
  // An error of the one who takes them ends the drive, as it says it.
  const auto ended = scan_drive(drive, 3, [](std::int64_t k, GpsTime, const LidarOutput&, const scene::SceneAt&) {
    return k == 1 ? Status(Error{"", 0, "", "enough", ""}) : Status(Ok{});
  });
  looks.right(!ended && ended.error().what == "enough");
  return looks.figure();
}

/// Pulses of other sensors in a place of nothing: each shot of a share is answered, at any range alike; count, mean and
/// mean square of the range by five deviations; none without any.
StressFigure others_light(double share) {
  Looks looks;
  scene::SceneParts parts = hall_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("far", scene::ObjectKind::kTerrain);
  mesh.quad({-1, -1, -900}, {1, -1, -900}, {1, 1, -900}, {-1, 1, -900}, mesh.material("asphalt"));
  ScanDrive drive = drive_in(std::make_shared<const scene::Scene>(std::move(parts)), "vlp16");
  drive.lidar.crosstalk.probability = share;
  drive.lidar.report.min_range_m = 2.0, drive.lidar.report.max_range_m = 80.0;
  drive.lidar.detector.name = "ideal";
  double n = 0.0, sum = 0.0, square = 0.0;
  const auto cost = scan_drive(drive, 5, [&](std::int64_t, GpsTime, const LidarOutput& out, const scene::SceneAt&) {
    for (const LidarPoint& p : out.scan.points) {
      const double range = Vector3d(p.x, p.y, p.z).norm();
      looks.right(range > 1.8 && range < 80.2);
      n += 1.0, sum += range, square += range * range;
    }
    return Status(Ok{});
  });
  looks.right(cost.ok());
  if (!cost) return looks.figure();
  const auto rays = static_cast<double>(cost->rays);
  looks.near(n, share * rays, 5.0 * std::sqrt(rays * share * (1.0 - share)) + 1e-6);
  if (share == 0.0) return looks.figure();
  // Lasers sit up to some centimetres off the middle: of the same size as what is asked for.
  const double a = 2.0, b = 80.0, mean = 0.5 * (a + b), mean2 = (a * a + a * b + b * b) / 3.0;
  looks.near(sum / n, mean, 5.0 * (b - a) / std::sqrt(12.0 * n) + 0.1);
  looks.near(
      square / n, mean2,
      5.0 * std::sqrt((std::pow(b, 5) - std::pow(a, 5)) / (5.0 * (b - a)) - mean2 * mean2) / std::sqrt(n) + 10.0);
  return looks.figure();
}

/// What faultless beams meet of the hall is on it, one point in each cube of 0.1 m, from places that are so far apart,
/// none beyond reach; and random points of its surfaces near a map are on it, as many as its area asks for: 16 in a
/// square metre, five deviations of their rounding.
StressFigure what_is_met() {
  Looks looks;
  ScanDrive drive = drive_in(hall(), "vlp16");
  drive.lidar.range_noise_m = 0.3;
  drive.lidar.report.range_quantum_m = 0.5;
  const auto found = beams_met(drive, 1.0, 12.0);
  looks.right(found.ok());
  if (!found) return looks.figure();
  looks.right(found->sensor_W.size() >= 4 && found->sensor_W.size() <= 5 && found->met_W.size() > 3000);
  for (std::size_t k = 1; k < found->sensor_W.size(); ++k) {
    const double apart = (found->sensor_W[k] - found->sensor_W[k - 1]).cast<double>().norm();
    looks.right(apart >= 1.0 && apart < 1.0 + 0.3);
  }
  std::vector<std::array<long, 3>> cubes;
  for (const Vector3f& p : found->met_W) {
    looks.near(off_the_hall(p.cast<double>()), 0.0, 17.0 * 1e-5 * 5.0 + 64.0 * kHalfUlp * 17.0);
    cubes.push_back({std::lround(std::floor(double{p.x()} / 0.1)), std::lround(std::floor(double{p.y()} / 0.1)),
                     std::lround(std::floor(double{p.z()} / 0.1))});
    double nearest = 1e9;
    for (const Vector3f& place : found->sensor_W) nearest = std::min(nearest, double{(p - place).norm()});
    looks.right(nearest <= 12.0 + 1e-4);
  }
  std::sort(cubes.begin(), cubes.end());
  looks.right(std::adjacent_find(cubes.begin(), cubes.end()) == cubes.end());
  // A map that is all of one wall and of no other: 18 x 10 m, and a metre of its four neighbours.
  std::vector<Vector3f> wall;
  for (int y = -90; y <= 90; ++y)
    for (int z = -50; z <= 50; ++z)
      wall.emplace_back(14.0f, 0.1f * static_cast<float>(y), 0.1f * static_cast<float>(z));
  const auto near = surfaces_near(PointGrid(wall, 2.0), *hall());
  double on_wall = 0.0, beside = 0.0;
  for (const Vector3f& p : near) {
    looks.near(off_the_hall(p.cast<double>()), 0.0, 1e-5);
    looks.right(p.x() > 12.99f);
    (std::abs(p.x() - 14.0f) < 1e-5f ? on_wall : beside) += 1.0;
  }
  looks.near(on_wall, 16.0 * 18.0 * 10.0, 2.0);
  // Of 56 m^2 beside it a share of each triangle by chance.
  looks.near(beside, 16.0 * 56.0, 5.0 * std::sqrt(16.0 * 56.0));
  return looks.figure();
}

/// Distances to a box that is turned anyhow, signed, at its faces, edges and corners, from outside and inside: closed
/// form; the offset leads to a surface, the normal is a face's, and beyond the cap nothing is found. Corners of single
/// precision: 4 half units of 60 m.
StressFigure signed_to_a_box(std::uint64_t seed) {
  Looks looks;
  const RandomStream draws(seed, "stress.offsets");
  const Eigen::Quaterniond R(so3_exp(2.0 * draws.normal3(0)));
  const Vector3d half(4.0, 2.0, 1.0), middle(30.0, -20.0, 12.0);
  scene::SceneParts parts = hall_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("box", scene::ObjectKind::kBuilding);
  mesh.box(middle, R.toRotationMatrix(), half, mesh.material("brick"));
  const scene::Scene scene(std::move(parts));
  const SignedDistance distance(scene);
  const double bound = 8.0 * kHalfUlp * 60.0;
  int inside = 0, corners = 0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    Vector3d p = Vector3d(draws.uniform(-7, 7, 1, k), draws.uniform(-4, 4, 2, k), draws.uniform(-3, 3, 3, k));
    // Some straight out of an edge or a corner, where faces share the nearest point.
    if (k % 4 == 0)
      for (int i = 0; i < 3; ++i)
        if (draws.uniform(4 + i, k) < 0.7)
          p[i] = (p[i] < 0.0 ? -1.0 : 1.0) * (half[i] + draws.uniform(0.01, 2.0, 7 + i, k));
    const Vector3d beyond = p.cwiseAbs() - half;
    const bool out = beyond.maxCoeff<Eigen::PropagateNaN>() > 0.0;
    const double expected = out ? beyond.cwiseMax(0.0).norm() : beyond.maxCoeff<Eigen::PropagateNaN>();
    const SurfaceOffset found = distance.at(middle + R * p, 100.0);
    looks.right(found.found);
    if (std::abs(expected) < 10.0 * bound) continue;
    looks.near(found.distance_m, expected, bound);
    looks.near(found.offset_W.norm(), std::abs(expected), bound);
    const Vector3d foot = R.conjugate() * (R * p - found.offset_W), normal = R.conjugate() * found.normal_W;
    looks.near((foot.cwiseAbs() - half).maxCoeff<Eigen::PropagateNaN>(), 0.0, bound);
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    looks.near(std::abs(normal[axis]), 1.0, 1e-5);
    looks.near(foot[axis] * (normal[axis] > 0.0 ? 1.0 : -1.0), half[axis], bound);
    looks.near(found.up_m(), found.offset_W.z(), 1e-300);
    looks.near(found.across_m(), std::hypot(found.offset_W.x(), found.offset_W.y()), 1e-12);
    looks.right(!distance.at(middle + R * p, 0.9 * std::abs(expected)).found);
    inside += out ? 0 : 1;
    corners += (beyond.array() > 0.0).count() == 3 ? 1 : 0;
  }
  looks.right(inside > 20 && corners > 20);
  return looks.figure();
}

/// Patches of a wall of 20 x 8 m: as many as squares of 2 m have enough points; their thickness is the spread of what
/// was put there between a twentieth and nineteen, and two layers are told from evenly spread points and from one thin
/// one, with their gap. Ground, a tree and a roof do not count.
StressFigure patches_of_walls(double apart_m, double spread_m) {
  Looks looks;
  const RandomStream draws(2, "stress.patches");
  scene::SceneParts parts = hall_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.quad({11, -20, 0}, {11, 0, 0}, {11, 0, 8}, {11, -20, 8}, mesh.material("concrete"));
  mesh.begin_object("tree", scene::ObjectKind::kTree);
  mesh.quad({-10, 0, 0}, {-10, -20, 0}, {-10, -20, 8}, {-10, 0, 8}, mesh.material("bark"));
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-9, -20, 0}, {9, -20, 0}, {9, 0, 0}, {-9, 0, 0}, mesh.material("asphalt"));
  const scene::Scene scene(std::move(parts));
  const SignedDistance distance(scene);
  std::vector<WallPoint> points;
  const auto add = [&](const Vector3d& p) {
    points.push_back({p.cast<float>(), {}});
    points.back().offset = distance.at(points.back().p_W.cast<double>(), 2.0);
  };
  // 200 points in each patch but the last column, which has 19: too few.
  for (int column = 0; column < 10; ++column)
    for (int row = 0; row < 4; ++row)
      for (std::uint64_t k = 0; k < (column == 9 ? 19U : 200U); ++k) {
        const auto n = k + 1000 * static_cast<std::uint64_t>(10 * row + column);
        const double layer = k % 2 == 0 ? -0.5 * apart_m : 0.5 * apart_m;
        // Evenly spread, in turn over the spread, so that its quantiles are known.
        const double even = spread_m * ((static_cast<double>(k / 2) + 0.5) / 100.0 - 0.5);
        add({11.0 + layer + even, -2.0 * column - draws.uniform(0.05, 1.95, 0, n),
             2.0 * row + draws.uniform(0.05, 1.95, 1, n)});
      }
  for (std::uint64_t k = 0; k < 300; ++k) {
    add({-10.0 + draws.uniform(-0.5, 0.5, 2, k), draws.uniform(-20, 0, 3, k), draws.uniform(0.5, 8, 4, k)});
    add({draws.uniform(-8, 8, 5, k), draws.uniform(-19, -1, 6, k), 0.3});
  }
  const WallThickness found = wall_thickness(points, scene);
  looks.right(found.patches == 36);
  // Two overlapping even layers: the quantiles of 200 places in order, to their steps.
  std::vector<double> sorted;
  for (int k = 0; k < 200; ++k)
    sorted.push_back((k % 2 == 0 ? -0.5 : 0.5) * apart_m + spread_m * ((k / 2 + 0.5) / 100.0 - 0.5));
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    const double place = share * 199.0;
    const auto i = static_cast<std::size_t>(place);
    return sorted[i] + (place - std::floor(place)) * (sorted[i + 1] - sorted[i]);
  };
  const double thick = at(0.95) - at(0.05);
  looks.near(found.median_m, thick, 1e-5), looks.near(found.p95_m, thick, 1e-5);
  // Even spread about two layers: between them is apart^2 / 4 of apart^2 / 4 + spread^2 / 12.
  const double between = apart_m * apart_m / 4.0, share = between / (between + spread_m * spread_m / 12.0);
  const bool doubled = apart_m > spread_m && share > 0.85 && apart_m >= 0.1;
  looks.near(found.doubled_share, doubled ? 1.0 : 0.0, 1e-9);
  if (doubled) looks.near(found.doubled_gap_median_m, apart_m, 1e-5);
  if (!doubled) looks.right(std::isnan(found.doubled_gap_median_m));
  looks.right(wall_thickness({}, scene).patches == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> offset_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "whole drives of a scanner in a closed hall",
           "a stamp's latency that moves the sensor, a pose of another instant, a scan too many",
           "every point on the hall's walls, every scan at its stamp: chords of the motion", "of the bound"});
  rows.add("scans/hall_by_vlp16", [] { return walls_of_a_hall("vlp16", 0.0); })
      .add("scans/hall_by_vlp16_late", [] { return walls_of_a_hall("vlp16", 0.07); })
      .add("scans/hall_by_a_grid", [] { return walls_of_a_hall("grid:16:-15:15", 0.0); });
  rows.of({StressGroup::kData, "pulses of other sensors", "a share of the lasers, or ranges that prefer near ones",
           "count, mean and square of what is drawn: five deviations", "of the bound"});
  for (const double share : {0.0, 0.02, 0.5})
    rows.add("scans/light_of_others_" + stress::text(share), [share] { return others_light(share); });
  rows.of({StressGroup::kData, "what a map of a drive ought to hold", "beams that err, a cube that counts twice",
           "on the walls, a point a cube, within reach; points by area", "of the bound"});
  rows.add("scans/what_is_met", what_is_met);
  rows.of({StressGroup::kGeometry, "signed distances at faces, edges and corners",
           "a sign by one of the faces that meet there", "a box in closed form: single precision of its corners",
           "of the bound"});
  for (const std::uint64_t seed : {1U, 2U, 3U})
    rows.add("scans/signed_to_a_box_" + std::to_string(seed), [seed] { return signed_to_a_box(seed); });
  rows.of({StressGroup::kData, "patches of walls that stand twice, or are thick",
           "a patch of another wall, a quantile off by one, layers where there is an even spread",
           "quantiles and gaps of what was put there: single precision", "of the bound"});
  for (const auto& [apart_m, spread_m] : {std::pair{0.3, 0.1}, {0.08, 0.01}, {0.2, 0.3}, {0.0, 0.05}, {0.4, 0.38}})
    rows.add("scans/walls_" + stress::text(apart_m) + "_m_apart_and_" + stress::text(spread_m) + "_m_thick",
             [apart_m = apart_m, spread_m = spread_m] { return patches_of_walls(apart_m, spread_m); });
  return rows.take();
}

}  // namespace canyon::lidar
