// What an autonomy makes of where it is and what it sees: its local frame, the ground, the street and facades.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/facade.h"
#include "canyon/mission/autonomy/known_vehicle.h"
#include "canyon/mission/autonomy/path.h"
#include "canyon/mission/autonomy/perception/blocked_cells.h"
#include "canyon/mission/autonomy/perception/kerb_rises.h"
#include "canyon/mission/autonomy/perception/lane_reference.h"
#include "canyon/mission/autonomy/perception/odometry_frame.h"
#include "canyon/mission/autonomy/perception/polar_ground.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/stress/autonomy_parts.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kInfinity;
using stress::Looks;

/// The way by the mean of two speeds along the heading of now, as local_frame.h says, over a course that winds, with
/// estimates that jump; what stands does not go.
StressFigure local_frames() {
  Looks looks;
  const RandomStream draws(15, "stress.plans");
  OdometryFrame frame;
  Vector2d place(0.0, 0.0);
  double before = 0.0, driven = 0.0, at_s = 0.0;
  for (int k = 0; k < 300; ++k) {
    const double dt_s = k == 0 ? 0.0 : draws.uniform(0.005, 0.03, 0, k), yaw = 0.02 * k + 0.3 * std::sin(0.1 * k);
    at_s += std::round(dt_s * 1e6) * 1e-6;
    const double exact_dt = std::round(dt_s * 1e6) * 1e-6;
    NavEstimate e;
    e.t = GpsTime::from_week_sow(1600, 0.0) + at_s;
    e.X_WB.R = rotation_from({.yaw_rad = yaw, .pitch_rad = 0.05, .roll_rad = -0.03});
    e.X_WB.p = {draws.uniform(-9, 9, 1, k), draws.uniform(-9, 9, 2, k), 3.0};
    e.v_WB_W = {draws.uniform(-4, 4, 3, k), draws.uniform(-4, 4, 4, k), 0.2};
    const bool stands = k > 0 && k % 7 == 0;
    const double speed = std::cos(yaw) * e.v_WB_W.x() + std::sin(yaw) * e.v_WB_W.y();
    const double mean = k == 0 ? speed : (before + speed) / 2.0;
    if (!stands) {
      place += exact_dt * mean * Vector2d(std::cos(yaw), std::sin(yaw));
      driven += std::abs(exact_dt * mean);
    }
    before = speed;
    frame.follow(e, stands);
    // Times are whole nanoseconds of a second count: 1e-9 s at 6 m/s, each.
    const double bound = 1e-8 * (k + 1);
    looks.near((frame.body().p_m - place).norm(), 0.0, bound);
    looks.near(frame.driven_m(), driven, bound);
    looks.near(frame.speed_m_s(), speed, 1e-13);
    looks.near((frame.from_O_to_W() + frame.body().p_m - e.X_WB.p.head<2>()).norm(), 0.0, 1e-13);
    NavEstimate later = e;
    later.t = e.t + 0.04;
    later.X_WB.R = rotation_from({.yaw_rad = yaw + 0.1, .pitch_rad = 0.0, .roll_rad = 0.0});
    const PlanPose there = frame.at(later);
    looks.near(
        (there.p_m - frame.body().p_m - 0.04 * speed * Vector2d(std::cos(yaw + 0.1), std::sin(yaw + 0.1))).norm(), 0.0,
        1e-8);
  }
  return looks.figure();
}

/// Returns of an even slope in every sector, with things standing on it: the ground is the slope at the middle of every
/// bin, 16 roundings of single precision of 3 m, and beyond the last return it may rise by the steepest.
StressFigure polar_ground() {
  Looks looks;
  const double rise = 0.07, steepest = 0.12;
  PolarGround ground({.max_slope = steepest, .noise_m = 0.05}, 30.0);
  std::vector<PlaneReturn> returns;
  std::array<int, PolarGround::kSectors> met{};
  const auto at = [&](double azimuth, double distance, double above) {
    returns.push_back({static_cast<float>(distance * std::cos(azimuth)),
                       static_cast<float>(distance * std::sin(azimuth)), static_cast<float>(above)});
  };
  for (int k = 0; k < 2400; ++k) {
    const double azimuth = (k + 0.37) * 2.0 * kPi / 2400;
    ++met[static_cast<std::size_t>(
        PolarGround::sector(static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth))))];
    for (double d = 0.31; d < 21.5; d += 0.7) {
      at(azimuth, d, rise * d);
      at(azimuth, d, rise * d + 0.9);  // on it
    }
  }
  ground.fit(returns);
  for (const int n : met) looks.right(n >= 5 && n <= 30);
  const double grain = 16.0 * stress::kHalfUlp * 3.0;
  for (int s = 0; s < PolarGround::kSectors; ++s)
    for (int bin = 0; bin < 60; ++bin) {
      const double middle = 0.5 * bin + 0.25;
      const PolarGround::Height h = ground.at(s, static_cast<float>(middle));
      const double last = 0.31 + 0.7 * 30.0;
      // A bin that has a return has no more than its height after it.
      const double in_bin = 0.31 + 0.7 * std::ceil((0.5 * bin - 0.31) / 0.7);
      const double level = in_bin < 0.5 * (bin + 1) && in_bin < middle ? in_bin : middle;
      looks.near(static_cast<double>(h.above_m), rise * (level < last ? level : last), grain);
      looks.near(static_cast<double>(h.unsure_m), middle > last ? steepest * (middle - last) : 0.0, grain);
    }
  return looks.figure();
}

/// A street at any angle, told `off_m` beside where it is: after long the lane is where the two variances have it; on
/// the way it goes half a metre a second. Roundings of 100 m.
StressFigure seen_street(double turn_rad) {
  Looks looks;
  const Vector2d u(std::cos(turn_rad), std::sin(turn_rad)), left(-u.y(), u.x()), told(37.0, -11.0);
  const auto lane_after = [&](double seconds, double sigma_m, double off_m, double left_m, double right_m, int slices,
                              double bend_m = 0.0) {
    const auto lane = model_row(lane_references(), "seen_street").make(ReferenceParameters{}.lane.model.own);
    const Path route({told, told + 100.0 * u}, 6.5);
    std::vector<Vector2d> walls;
    for (int k = 0; k < slices; ++k)
      for (const double x : {0.3, 0.7}) {
        walls.push_back(u * (20.0 + k + x) + left * (left_m + bend_m * k));
        walls.push_back(u * (20.0 + k + x) + left * (right_m + bend_m * k));
      }
    const BlockedCells blocked(20.0 * u, walls);
    double middle = 0.0;
    const PlanPose body{20.0 * u, turn_rad};
    for (int k = 0; k < static_cast<int>(std::lround(seconds * 10.0)); ++k)
      middle = lane->middle_m({route, 20.0, told + off_m * left, body, sigma_m, 0.1, blocked});
    return middle;
  };
  for (const double sigma_m : {0.3, 0.8, 2.0, 5.0})
    for (const double off_m : {-1.5, 0.0, 0.7}) {
      // The middle of walls at 8 and -7 is 0.5 left; the route runs at -off.
      const double seen = 0.5 + off_m, share = sigma_m * sigma_m / (sigma_m * sigma_m + 1.0);
      const bool doubted = seen * seen > 9.0 * (1.0 + sigma_m * sigma_m);
      if (doubted) continue;
      looks.near(lane_after(20.0, sigma_m, off_m, 8.0, -7.0, 21), share * seen, 1e-11);
      const double soon = lane_after(0.2, sigma_m, off_m, 8.0, -7.0, 21), full = share * seen;
      looks.near(soon, std::abs(full) < 0.1 ? full : std::copysign(0.1, full), 1e-11);
    }
  // Beyond three sigma of both for three seconds it is the estimate that errs.
  const double seen = 5.5, sigma2 = 0.25, beyond = sigma2 + seen * seen - 9.0 * (1.0 + sigma2);
  looks.near(lane_after(40.0, 0.5, 5.0, 8.0, -7.0, 21), seen * beyond / (beyond + 1.0), 1e-11);
  looks.near(lane_after(2.9, 0.5, 5.0, 8.0, -7.0, 21), seen * sigma2 / (sigma2 + 1.0), 1e-11);
  // Too narrow, too wide, seen in too few slices, and bent.
  looks.near(lane_after(20.0, 2.0, 0.0, 2.0, -2.5, 21), 0.0, 1e-11);
  looks.near(lane_after(20.0, 2.0, 0.0, 16.0, -10.0, 21), 0.0, 1e-11);
  looks.near(lane_after(20.0, 2.0, 0.0, 8.0, -7.0, 7), 0.0, 1e-11);
  looks.near(lane_after(20.0, 2.0, 0.0, 8.0, -7.0, 8), 0.5 * 0.8, 1e-11);
  looks.near(lane_after(20.0, 2.0, 0.0, 8.0, -7.0, 21, 0.3), 0.0, 1e-11);
  looks.near(lane_after(20.0, 2.0, 0.0, 3.05, -2.05, 21), 0.5 * 0.8, 1e-11);
  looks.near(lane_after(20.0, 2.0, 0.0, 12.8, -11.8, 21), 0.5 * 0.8, 1e-11);
  return looks.figure();
}

/// Sixteen rings, from 1.8 m, over a level street at any angle between two kerbs 6 m off: without noise each rise lies
/// within the step across that it is looked for in, and a street without kerbs has none.
StressFigure kerbs(double turn_rad, double height_m) {
  Looks looks;
  constexpr double kAbove_m = 1.8, kToKerb_m = 6.0;
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()));
  LidarScan scan;
  for (int ring = 0; ring < 16; ++ring)
    for (int step = 0; step < 900; ++step) {
      const double e = (2 * ring - 15) * kDegree, a = step * 0.4 * kDegree;
      const Eigen::Vector3d d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      if (d.z() >= 0.0) continue;
      double way_m = kAbove_m / -d.z();
      if (way_m * std::abs(d.y()) > kToKerb_m) {
        const double face_m = kToKerb_m / std::abs(d.y());
        way_m = (kAbove_m - height_m) / -d.z();
        if (way_m < face_m) way_m = face_m;
      }
      const Eigen::Vector3f q = (turned * (way_m * d)).cast<float>();
      scan.points.push_back({q.x(), q.y(), q.z(), 0.3F, 0.0F, static_cast<std::uint16_t>(ring), 0});
    }
  const Pose X_OL{Eigen::Quaterniond::Identity(), {37.0, -11.0, kAbove_m}};
  const Vector2d u(std::cos(turn_rad), std::sin(turn_rad)), left(-u.y(), u.x());
  int sides[2] = {0, 0};
  for (const Vector2d& p : kerb_rises({.scan = scan, .X_OL = X_OL, .origin = X_OL.p.head<2>(), .along = u})) {
    const double aside_m = left.dot(p - X_OL.p.head<2>());
    looks.near(std::abs(aside_m), kToKerb_m, 0.12);
    ++sides[aside_m > 0.0 ? 0 : 1];
  }
  for (const int count : sides) looks.near(count >= 3 ? 1.0 : 0.0, height_m > 0.0 ? 1.0 : 0.0, 1e-12);
  return looks.figure();
}

/// Of a house's walls the one that looks widest from a place, by its angle; 25 points evenly on it, 5 cm out.
StressFigure facades() {
  Looks looks;
  scene::Building house;
  house.footprint_W = {{10.0, 5.0}, {22.0, 8.0}, {20.0, 16.0}, {8.0, 13.0}};
  house.base_m = 2.0;
  house.height_m = 15.0;
  for (int k = 0; k < 64; ++k) {
    const double a = 2.0 * kPi * (k + 0.3) / 64;
    const Vector2d from = Vector2d(15.0, 10.5) + 40.0 * Vector2d(std::cos(a), std::sin(a));
    const auto points = facade_points(house, from);
    if (points.size() != 25) return {kInfinity, 1.0};
    double best = -kInfinity;
    std::size_t wall = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d p = house.footprint_W[i], q = house.footprint_W[(i + 1) % 4], middle = 0.5 * (p + q);
      const Vector2d along = q - p, sight = from - middle;
      const double apparent = (along.y() * sight.x() - along.x() * sight.y()) / sight.squaredNorm();
      if (apparent > best) best = apparent, wall = i;
    }
    const Vector2d p = house.footprint_W[wall], along = house.footprint_W[(wall + 1) % 4] - p;
    const Vector2d out = Vector2d(along.y(), -along.x()) / along.norm();
    for (int row = 0; row < 5; ++row)
      for (int column = 0; column < 5; ++column) {
        const Vector2d on = p + along * (0.1 + 0.2 * column) + 0.05 * out;
        const Eigen::Vector3d expected(on.x(), on.y(), 2.0 + 15.0 * (0.1 + 0.2 * row));
        looks.near((points[static_cast<std::size_t>(5 * row + column)] - expected).norm(), 0.0, 1e-13);
      }
  }
  looks.right(facade_points(house, {15.0, 10.5}).empty());
  return looks.figure();
}

}  // namespace

std::vector<StressCase> perception_cases() {
  StressRows rows;
  rows.of(autonomy_part());
  rows.add("perception/local_frames", local_frames)
      .add("perception/polar_ground", polar_ground)
      .add("perception/facades", facades);
  for (const double turn : {0.0, 1.0, -2.5})
    rows.add("perception/seen_street_turned_by_" + stress::text(turn), [turn] { return seen_street(turn); });
  for (const double height_m : {0.0, 0.08, 0.15})
    rows.add("perception/kerbs_of_" + stress::text(height_m), [height_m] { return kerbs(0.7, height_m); });
  return rows.take();
}

}  // namespace canyon::mission
