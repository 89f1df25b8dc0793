// The parts of an autonomy by themselves, each against its formula or a search through everything.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/facade.h"
#include "canyon/mission/autonomy/perception/lane_reference.h"
#include "canyon/mission/autonomy/perception/local_frame.h"
#include "canyon/mission/autonomy/perception/polar_ground.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/autonomy/route_driver.h"
#include "canyon/mission/autonomy/self_check/planar_match.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

const RandomStream kDraws(15, "stress.plans");
double drawn(double low, double high, std::uint32_t what, int k) {
  return kDraws.uniform(low, high, what, static_cast<std::uint64_t>(k));
}

/// Along and to the left of a heading.
Vector2d seen_from(const Vector2d& p, const Vector2d& at, double yaw) {
  const Vector2d d = p - at;
  return {d.x() * std::cos(yaw) + d.y() * std::sin(yaw), d.y() * std::cos(yaw) - d.x() * std::sin(yaw)};
}
double outside(const Vector2d& seen, const KnownVehicle& v) {
  const double behind = v.rear_m - seen.x(), before = seen.x() - v.front_m,
               beside = std::abs(seen.y()) - v.half_width_m;
  const double x = behind > 0.0 ? behind : before > 0.0 ? before : 0.0;
  return std::hypot(x, beside > 0.0 ? beside : 0.0);
}

/// An arc by 4000 chords' middles, whose error is (kappa d)^2 d / (24 n^2); back along it.
StressFigure arcs() {
  Looks looks;
  for (const double kappa : {0.0, 1e-9, 1e-5, 0.02, -0.35, 1.0})
    for (const double way : {-7.0, 0.3, 12.0}) {
      const PlanPose from{{3.0, -2.0}, 0.7};
      const PlanPose to = from.along(kappa, way);
      Vector2d p = from.p_m;
      constexpr int kSteps = 4000;
      for (int k = 0; k < kSteps; ++k) {
        const double yaw = 0.7 + kappa * way * (k + 0.5) / kSteps;
        p += way / kSteps * Vector2d(std::cos(yaw), std::sin(yaw));
      }
      const double turn = std::abs(kappa * way), truncated = turn * turn * std::abs(way) / 24.0 / 1.6e7;
      looks.near((to.p_m - p).norm(), 0.0, truncated + 4000.0 * kEpsilon * 12.0);
      looks.near(to.yaw_rad, 0.7 + kappa * way, 8.0 * kEpsilon * (1.0 + turn));
      looks.near((to.along(kappa, -way).p_m - from.p_m).norm(), 0.0, 64.0 * kEpsilon * 20.0);
      looks.near((to.forward() - Vector2d(std::cos(to.yaw_rad), std::sin(to.yaw_rad))).norm(), 0.0, 4.0 * kEpsilon);
    }
  return looks.figure();
}

/// The nearest of all cells within reach of the table, one by one; 64 eps of 90 m.
StressFigure clearances() {
  Looks looks;
  KnownVehicle vehicle;
  vehicle.rear_m = -0.7;
  const Vector2d centre(11.0, -23.0);
  std::vector<Vector2d> cells;
  for (int k = 0; k < 900; ++k)
    cells.emplace_back(centre.x() + drawn(-70, 70, 0, k), centre.y() + drawn(-70, 70, 1, k));
  const BlockedCells blocked(centre, cells);
  std::size_t within = 0;
  for (const Vector2d& c : cells)
    within += std::abs(c.x() - centre.x()) < 64.0 && std::abs(c.y() - centre.y()) < 64.0 ? 1 : 0;
  looks.right(blocked.all().size() == within);
  for (int k = 0; k < 400; ++k) {
    const PlanPose body{{centre.x() + drawn(-80, 80, 2, k), centre.y() + drawn(-80, 80, 3, k)}, drawn(-4, 4, 4, k)};
    for (const double cap_m : {0.3, 2.0, 9.0}) {
      double nearest = cap_m;
      for (const Vector2d& c : cells) {
        if (std::abs(c.x() - centre.x()) >= 64.0 || std::abs(c.y() - centre.y()) >= 64.0) continue;
        const double d = outside(seen_from(c, body.p_m, body.yaw_rad), vehicle);
        nearest = d < nearest ? d : nearest;
      }
      looks.near(blocked.clearance_m(body, vehicle, cap_m), nearest, 64.0 * kEpsilon * 90.0);
    }
  }
  return looks.figure();
}

/// The way by the mean of two speeds along the heading of now, as local_frame.h says, over a course that winds, with
/// estimates that jump; what stands does not go.
StressFigure local_frames() {
  Looks looks;
  LocalFrame frame;
  Vector2d place(0.0, 0.0);
  double before = 0.0, driven = 0.0, at_s = 0.0;
  for (int k = 0; k < 300; ++k) {
    const double dt_s = k == 0 ? 0.0 : drawn(0.005, 0.03, 0, k), yaw = 0.02 * k + 0.3 * std::sin(0.1 * k);
    at_s += std::round(dt_s * 1e6) * 1e-6;
    const double exact_dt = std::round(dt_s * 1e6) * 1e-6;
    NavEstimate e;
    e.t = GpsTime::from_week_sow(1600, 0.0) + at_s;
    e.X_WB.R = rotation_from({.yaw_rad = yaw, .pitch_rad = 0.05, .roll_rad = -0.03});
    e.X_WB.p = {drawn(-9, 9, 1, k), drawn(-9, 9, 2, k), 3.0};
    e.v_WB_W = {drawn(-4, 4, 3, k), drawn(-4, 4, 4, k), 0.2};
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

PlanLine winding() {
  PlanLine line;
  double yaw = 0.4;
  Vector2d p(1.0, -2.0);
  for (int k = 0; k < 160; ++k) {
    line.points_O.push_back(p);
    yaw += 0.04 * std::sin(0.11 * k);
    p += PlanLine::kSpacing_m * Vector2d(std::cos(yaw), std::sin(yaw));
  }
  return line;
}

/// Both trackers' laws on a line that winds, from beside it: 64 eps.
StressFigure trackers_laws() {
  Looks looks;
  KnownVehicle vehicle;
  const ReferenceParameters defaults;
  const auto pursuit = model_row(trackers(), "pure_pursuit").make(defaults.tracker.model.own, vehicle);
  ModelChoice<trackers> second("stanley");
  const auto stanley = model_row(trackers(), "stanley").make(second.own, vehicle);
  const PlanLine line = winding();
  for (int k = 0; k < 300; ++k) {
    const auto i = static_cast<std::size_t>(k % 110);
    const double yaw = std::atan2(line.direction(i).y(), line.direction(i).x()) + drawn(-0.5, 0.5, 0, k);
    const PlanPose body{line.at(i) + Vector2d(drawn(-1, 1, 1, k), drawn(-1, 1, 2, k)), yaw};
    std::size_t best = 0;
    for (std::size_t j = 0; j < line.points_O.size(); ++j)
      if ((line.points_O[j] - body.p_m).norm() < (line.points_O[best] - body.p_m).norm()) best = j;
    looks.right(line.nearest(body.p_m, best > 30 ? best - 5 : 0) == best || best <= 30);
    for (const double speed : {0.0, 2.0, 4.1, 9.0}) {
      const double reach = 0.8 * speed < 2.5 ? 2.5 : 0.8 * speed > 5.0 ? 5.0 : 0.8 * speed;
      const Vector2d d = seen_from(line.at(best + static_cast<std::size_t>(std::lround(reach * 4.0))), body.p_m, yaw);
      const double expected = d.norm() < 0.5 ? 0.0
                              : d.x() < 0.0  ? std::copysign(1.0, d.y())
                                             : 2.0 * d.y() / d.squaredNorm();
      looks.near(pursuit->curvature_1_m(line, best, body, speed), expected, 1e-12);
      const Vector2d front = body.p_m + vehicle.wheelbase_m * Vector2d(std::cos(yaw), std::sin(yaw));
      const std::size_t f = line.nearest(front, best);
      const Vector2d along = (line.points_O[f + 1] - line.points_O[f]).normalized();
      const Vector2d beside = seen_from(front, line.points_O[f], std::atan2(along.y(), along.x()));
      const double turn = std::remainder(std::atan2(along.y(), along.x()) - yaw, 2.0 * kPi);
      double angle = turn - std::atan2(beside.y(), 1.0 + speed);
      angle = angle > 1.3 ? 1.3 : angle < -1.3 ? -1.3 : angle;  // its limit
      looks.near(stanley->curvature_1_m(line, best, body, speed), std::tan(angle) / vehicle.wheelbase_m, 1e-11);
    }
  }
  // Steering by its limits.
  for (int k = 0; k < 200; ++k) {
    const double now = drawn(-0.55, 0.55, 5, k), kappa = drawn(-0.6, 0.6, 6, k), dt_s = drawn(0.001, 0.8, 7, k);
    double wanted = std::atan(kappa * 1.8);
    wanted = wanted > 0.5585 ? 0.5585 : wanted < -0.5585 ? -0.5585 : wanted;
    const double most = 0.7854 * dt_s, change = wanted - now;
    looks.near(steered_rad(now, kappa, dt_s, vehicle),
               now + (change > most    ? most
                      : change < -most ? -most
                                       : change),
               1e-15);
  }
  return looks.figure();
}

/// v t + v^2 / (2 b) is just the way that is free, or seen; bends by v^2 kappa after braking up to them.
StressFigure speeds() {
  Looks looks;
  const auto rule = model_row(speed_rules(), "stopping_distance").make(ReferenceParameters{}.speed.model.own);
  for (int k = 0; k < 400; ++k) {
    SpeedTask task;
    task.route_m_s = drawn(0.5, 14, 0, k);
    task.free_to_end = k % 3 == 0;
    task.free_m = drawn(0.0, 30, 1, k);
    task.seen_m = drawn(0.0, 40, 2, k);
    task.braking_m_s2 = drawn(0.5, 3, 3, k);
    task.lateral_m_s2 = drawn(0.5, 3, 4, k);
    std::vector<float> bends;
    for (int i = 0; i < 60; ++i)
      bends.push_back(static_cast<float>(i % 20 == 7 ? drawn(-0.5, 0.5, 5, 64 * k + i) : 0.0));
    task.curvature_1_m = bends;
    const auto halting = [&](double way) {
      // The root of v^2 / (2 b) + 0.3 v = way by bisection.
      double low = 0.0, high = 100.0;
      for (int i = 0; i < 80; ++i) {
        const double v = 0.5 * (low + high);
        (v * v / (2.0 * task.braking_m_s2) + 0.3 * v < way ? low : high) = v;
      }
      return low;
    };
    double v = task.route_m_s;
    const auto no_more = [&](double most) { v = most < v ? most : v; };
    if (!task.free_to_end) no_more(task.free_m <= 0.5 ? 0.0 : halting(task.free_m - 0.5));
    no_more(halting(task.seen_m < 8.0 ? 8.0 : task.seen_m));
    for (std::size_t i = 0; i < bends.size(); ++i)
      if (bends[i] != 0.0f) {
        const double in_bend2 = task.lateral_m_s2 / std::abs(static_cast<double>(bends[i]));
        no_more(std::sqrt(in_bend2 + 2.0 * task.braking_m_s2 * 0.25 * static_cast<double>(i)));
      }
    looks.near(rule->allowed_m_s(task), v < 0.1 ? 0.0 : v, 1e-12);
  }
  return looks.figure();
}

/// A straight way between walls and up to one: how far, how close, and how much.
StressFigure driven_arcs() {
  Looks looks;
  const KnownVehicle vehicle;
  const auto pursuit = model_row(trackers(), "pure_pursuit").make(ReferenceParameters{}.tracker.model.own, vehicle);
  PlanLine line;
  for (double x = -1.0; x <= 60.0; x += PlanLine::kSpacing_m) line.points_O.emplace_back(x, 0.0);
  for (const double aside_m : {1.2, 1.31, 1.5, 1.7})
    for (const double wall_m : {9.1, 14.4, 100.0}) {
      std::vector<Vector2d> cells;
      for (double x = -5.0; x < 60.0; x += 0.2) cells.emplace_back(x, aside_m);
      for (double y = -3.0; y < 1.0; y += 0.2) cells.emplace_back(wall_m, y);
      const BlockedCells blocked({0.0, 0.0}, cells);
      const DrivenArc arc = drive_in_thought(line, {{{0.0, 0.0}, 0.0}, 3.0, 0.0}, 18.0,
                                             {.least_m = 0.3, .comfort_m = 0.8}, *pursuit, blocked, vehicle);
      // The body: 2.2 m before its axle, and 0.3 m more; half a body and what is beside it.
      const double room_m = wall_m - 2.2 - 0.3, aside = aside_m - 0.75;
      const double free = room_m < 18.0 ? 0.25 * std::floor(room_m / 0.25 + 1e-9) : 18.0;
      looks.near(arc.free_m, free, 1e-12);
      looks.right(arc.ends_free == (room_m >= 18.0));
      double close = 0.0;
      for (int i = 1; i <= static_cast<int>(std::lround(free / 0.25)); ++i) {
        const double before_m = wall_m - 2.2 - 0.25 * i;
        const double nearest = before_m < aside ? before_m : aside;
        close += nearest < 0.8 ? 0.25 * (0.8 - nearest) : 0.0;
      }
      looks.near(arc.closeness_m2, close, 1e-9);
      looks.near(free_along({{0.0, 0.0}, 0.0}, 0.0, 18.0, {}, blocked, vehicle), free, 1e-12);
      looks.near(free_along({{20.0, 0.0}, 0.0}, 0.0, -18.0, {}, blocked, vehicle),
                 wall_m < 100.0 ? 0.25 * std::floor((20.0 - 0.4 - 0.3 - wall_m) / 0.25 + 1e-9) : 18.0, 1e-12);
      for (const float kappa : arc.curvature_1_m) looks.near(static_cast<double>(kappa), 0.0, 1e-7);
    }
  // A body that already stands too near goes on where it comes no nearer, a little less near with every metre.
  std::vector<Vector2d> wall;
  for (double x = -5.0; x < 60.0; x += 0.2) wall.emplace_back(x, 0.95);
  const BlockedCells near({0.0, 0.0}, wall);
  looks.near(free_along({{0.0, 0.0}, 0.0}, 0.0, 10.0, {}, near, vehicle), 0.25 * std::floor(0.05 / 0.1 / 0.25), 1e-12);
  return looks.figure();
}

/// The plan that is chosen is the cheapest of all lines that could be: each laid out and driven here.
StressFigure cheapest_plan() {
  Looks looks;
  const KnownVehicle vehicle;
  const ReferenceParameters defaults;
  const auto pursuit = model_row(trackers(), "pure_pursuit").make(defaults.tracker.model.own, vehicle);
  for (int k = 0; k < 12; ++k) {
    const auto planner = model_row(local_planners(), "offsets").make(defaults.planner.model.own);
    const Vector2d to_W(drawn(-5, 5, 0, k), drawn(-5, 5, 1, k));
    const Path route({to_W, to_W + Vector2d(30.0, 0.0), to_W + Vector2d(52.0, 12.0 + k)}, 8.0);
    std::vector<Vector2d> cells;
    for (int i = 0; i < 6; ++i) {
      const Vector2d post(drawn(14, 34, 2, 8 * k + i), drawn(-5, 5, 3, 8 * k + i));
      for (double y = -0.4; y <= 0.4; y += 0.2) cells.push_back(post + Vector2d(0.0, y));
    }
    const BlockedCells blocked({10.0, 0.0}, cells);
    const double lane_m = drawn(-0.5, 0.5, 4, k);
    double chosen_m = 0.0;
    for (const double x : {6.0, 9.0}) {
      const MovingBody body{{{x, drawn(-1, 1, 5, k)}, drawn(-0.1, 0.1, 6, k)}, 3.0, 0.05};
      const PlanTask task{route, x, to_W, lane_m, body, blocked, *pursuit, vehicle};
      const LocalPlan plan = planner->plan(task);
      const double here = seen_from(body.pose.p_m + to_W, route.at(x), 0.0).y() - lane_m;
      const auto line_of = [&](double offset, double blend) {
        PlanLine line;
        for (int i = 0; i <= 112; ++i) {
          const double ahead = 0.25 * i, s = x + ahead;
          const Vector2d u = route.direction(s);
          const Vector2d on = route.at(s) + (s > route.length_m() ? s - route.length_m() : 0.0) * u - to_W;
          const double side = lane_m + offset + (here - offset) * std::exp(-ahead / blend);
          line.points_O.emplace_back(on + side * Vector2d(-u.y(), u.x()));
        }
        return line;
      };
      const auto cost_of = [&](double offset, const DrivenArc& arc) {
        double turning = 0.0;
        for (std::size_t i = 0; i < arc.curvature_1_m.size(); ++i) {
          const double more =
              static_cast<double>(arc.curvature_1_m[i]) - route.curvature(x + 0.125 + 0.25 * static_cast<double>(i));
          turning += 0.25 * more * more;
        }
        return 4.0 * (22.0 - arc.free_m) + arc.closeness_m2 + 5.0 * turning +
               0.6 * (std::abs(offset) + 0.5 * std::abs(offset - chosen_m));
      };
      double best = kInfinity, of_plan = kInfinity;
      for (int step = -7; step <= 7; ++step)
        for (const double blend : {1.5, 3.0, 6.0}) {
          const PlanLine line = line_of(0.5 * step, blend);
          const DrivenArc arc = drive_in_thought(line, body, 22.0, planner->clearances(), *pursuit, blocked, vehicle);
          const double cost = cost_of(0.5 * step, arc);
          best = cost < best ? cost : best;
          double apart = 0.0;
          for (std::size_t i = 0; i < line.points_O.size(); ++i)
            apart = worse(apart, (line.points_O[i] - plan.line.points_O.at(i)).norm());
          if (apart < 1e-9) of_plan = cost;
        }
      looks.near(of_plan, best, 1e-9);
      looks.right(plan.horizon_m == 22.0 && plan.line.points_O.size() == 113);
      chosen_m = plan.offset_m;
    }
  }
  return looks.figure();
}

/// It waits two seconds, goes back straight for want of anything better by at most six metres, braking at half a metre
/// per second squared, until a way ahead is there.
StressFigure backing_up() {
  Looks looks;
  const KnownVehicle vehicle;
  const BlockedCells nothing;
  LocalPlan plan;
  plan.arc.free_m = 1.0;
  const auto recovery = model_row(recoveries(), "back_up").make(ReferenceParameters{}.recovery.model.own);
  const auto ask = [&](double t_s, bool stuck, double driven_m, double speed, const BlockedCells& cells) {
    return recovery->act({t_s, stuck, driven_m, plan, {{{0.0, 0.0}, 0.0}, speed, 0.0}, {}, cells, vehicle});
  };
  looks.right(!ask(0.0, false, 0.0, 0.0, nothing) && !ask(1.0, true, 0.0, 0.0, nothing));
  looks.right(!ask(2.9, true, 0.0, 0.0, nothing) && !ask(2.95, false, 0.0, 0.0, nothing));
  looks.right(!ask(3.0, true, 0.0, 0.0, nothing) && !ask(4.99, true, 0.0, 0.0, nothing));
  for (double gone = 0.0; gone < 5.85; gone += 0.31) {
    const auto c = ask(5.0 + gone, true, gone, -1.0, nothing);
    if (!c) return {kInfinity, 1.0};
    const double most = std::sqrt(6.0 - gone);
    looks.near(c->speed_m_s, -(most < 1.0 ? most : 1.0), 1e-12);
    looks.near(c->curvature_1_m, 0.0, 1e-15);
  }
  // Once there is a way ahead, half a metre more.
  plan.arc.free_m = 8.5;
  looks.near(ask(11.0, true, 2.0, -1.0, nothing)->speed_m_s, -std::sqrt(0.5), 1e-12);
  looks.near(ask(11.1, true, 2.3, -1.0, nothing)->speed_m_s, -std::sqrt(0.2), 1e-12);
  looks.near(ask(11.2, true, 2.45, -0.5, nothing)->speed_m_s, 0.0, 1e-12);
  looks.near(ask(11.3, true, 2.45, -0.05, nothing)->speed_m_s, 0.0, 1e-12);
  looks.right(!ask(11.4, false, 2.45, 0.0, nothing));
  // A wall behind: on an arc, that which leads farther of those that turn.
  const auto second = model_row(recoveries(), "back_up").make(ReferenceParameters{}.recovery.model.own);
  plan.arc.free_m = 1.0;
  std::vector<Vector2d> post;
  for (double y = -1.4; y <= 0.6; y += 0.1) post.emplace_back(-3.0, y);
  const BlockedCells behind({0.0, 0.0}, post);
  const auto act = [&](double t_s) {
    return second->act({t_s, true, 0.0, plan, {{{0.0, 0.0}, 0.0}, 0.0, 0.0}, {}, behind, vehicle});
  };
  act(0.0);
  const auto c = act(2.0);
  if (!c) return {kInfinity, 1.0};
  const double lock = std::tan(vehicle.max_steering_rad) / vehicle.wheelbase_m;
  double longest = 0.0, of = 0.0;
  for (const double share : {0.0, 0.5, -0.5, 1.0, -1.0}) {
    const double way = free_along({}, share * lock, -6.0, {}, behind, vehicle);
    if (way > longest) longest = way, of = share * lock;
  }
  looks.near(c->curvature_1_m, of, 1e-12);
  return looks.figure();
}

/// A room whose walls do not meet: from where one has truly come to, nothing moves it, and it is as sure as its returns
/// say, each over a hundred times (3 cm)^2; from beside, what was known pulls by its share.
StressFigure matched_walls(double yaw_rad) {
  Looks looks;
  const Vector2d moved(0.21, -0.12);
  PlanarPoints before, now;
  std::vector<Vector2d> normals;
  const auto wall = [&](const Vector2d& p, const Vector2d& normal) {
    before.push_back(p);
    const Vector2d seen = seen_from(p, moved, yaw_rad);
    now.push_back(seen);
    normals.push_back(normal);
  };
  for (double v = -5.9; v < 6.0; v += 0.2) {
    wall({10.5, v}, {1.0, 0.0}), wall({-9.5, v}, {1.0, 0.0});
    wall({v, 8.5}, {0.0, 1.0}), wall({v, -7.5}, {0.0, 1.0});
  }
  const WallPieces pieces(before);
  looks.right(pieces.count() == 48);
  PlanarMotion known;
  known.pose = {moved, yaw_rad};
  known.covariance = Eigen::Vector3d(0.04, 0.09, 1e-4).asDiagonal();
  Eigen::Matrix3d H = known.covariance.inverse();
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vector2d arm = before[i] - moved;
    const Eigen::Vector3d slope(normals[i].x(), normals[i].y(), normals[i].dot(Vector2d(-arm.y(), arm.x())));
    H += slope * slope.transpose() / (9e-4 * 100.0);
  }
  const Eigen::Matrix3d P = H.inverse();
  const PlanarMotion still = pieces.match(now, known);
  looks.near((still.pose.p_m - moved).norm(), 0.0, 1e-12);
  looks.near(still.pose.yaw_rad, yaw_rad, 1e-13);
  looks.near((still.covariance - P).norm() / P.norm(), 0.0, 1e-10);
  PlanarMotion off = known;
  const Eigen::Vector3d by(0.05, -0.04, 0.004);
  off.pose = {moved + by.head<2>(), yaw_rad + by.z()};
  const PlanarMotion back = pieces.match(now, off);
  const Eigen::Vector3d left = P * known.covariance.inverse() * by;
  // Cauchy's weights and the turn's curvature are of second order: what is left squared over 3 cm, and 4e-3 squared of
  // 12 m; and it ends with steps of 1e-4 m.
  const double second = left.norm() * (left.norm() / 0.03 + 0.1) + 1e-4;
  looks.near((back.pose.p_m - moved - left.head<2>()).norm(), 0.0, second);
  looks.near(back.pose.yaw_rad - yaw_rad, left.z(), second / 8.0);
  // Seen by a scan, turned and lifted: the same points, once for every 0.2 m, within heights and reach.
  LidarScan scan;
  const Pose X_WB{rotation_from({.yaw_rad = 0.9, .pitch_rad = 0.0, .roll_rad = 0.0}), {5.0, -3.0, 2.0}};
  const Pose X_WL{rotation_from({.yaw_rad = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0}), {5.4, -2.7, 3.5}};
  int expected = 0;
  for (int i = 0; i < 40; ++i)
    for (int repeat = 0; repeat < 3; ++repeat) {
      const double height = std::array{0.5, 1.5, 3.2}[static_cast<std::size_t>(repeat)];
      const Eigen::Vector3d p_B(-31.0 + 1.5 * i + 0.07, 4.07, height);
      const Eigen::Vector3d p_L = X_WL.R.conjugate() * (X_WB.R * p_B + X_WB.p - X_WL.p);
      scan.points.push_back(
          {.x = static_cast<float>(p_L.x()), .y = static_cast<float>(p_L.y()), .z = static_cast<float>(p_L.z())});
      if (repeat != 1) continue;
      scan.points.push_back(scan.points.back());
      expected += p_B.head<2>().norm() < 28.0 ? 1 : 0;
    }
  const PlanarPoints stand = standing_points(scan, X_WL, X_WB, {});
  looks.right(static_cast<int>(stand.size()) == expected);
  for (const Vector2d& p : stand) {
    looks.near(p.y(), 4.07, 1e-5);
    looks.near(std::remainder(p.x() + 31.0 - 0.07, 1.5), 0.0, 1e-5);
  }
  return looks.figure();
}

/// Cruise, bends and stops on a route with one corner: each by its formula; waypoints one after another.
StressFigure route_speeds() {
  Looks looks;
  AutonomyConfig config;
  config.cruise_m_s = 5.5;
  config.waypoints = {{"by", {20.0, 0.0}, ""}, {"end", {40.0, 60.0}, ""}};
  PriorKnowledge prior;
  prior.route = Path({{0.0, 0.0}, {40.0, 0.0}, {40.0, 60.0}}, 6.0);
  prior.waypoint_s_m = {20.0, prior.route.length_m()};
  RouteDriver driver(config, prior);
  NavEstimate e;
  GpsTime t = GpsTime::from_week_sow(1600, 0.0);
  for (double s = 0.0; s < prior.route.length_m() - 1.0; s += 0.5) {
    const Vector2d p = prior.route.at(s), u = prior.route.direction(s);
    e.t = t = t + 0.1;
    e.X_WB.p = {p.x(), p.y(), 0.0};
    e.X_WB.R = rotation_from({.yaw_rad = std::atan2(u.y(), u.x()), .pitch_rad = 0.0, .roll_rad = 0.0});
    e.v_WB_W = {3.0 * u.x(), 3.0 * u.y(), 0.0};
    looks.right(!driver.update(e));
    looks.near(driver.s_m(), s, 1e-9);
    looks.right(driver.next_waypoint() == (s < 19.0 - 1e-9 ? 0 : 1) || std::abs(s - 19.0) < 1e-6);
    double v = config.cruise_m_s;
    for (int x = 0; x <= 12; ++x) {
      const double kappa = std::abs(prior.route.curvature(s + x));
      if (kappa < 1e-4) continue;
      const double most = std::sqrt(config.lateral_m_s2 / kappa + 2.0 * config.braking_m_s2 * (x > 1 ? x - 1.0 : 0.0));
      v = most < v ? most : v;
    }
    const double stop = prior.route.length_m() - s - 0.2;
    double last = stop > 0.0 ? std::sqrt(2.0 * config.braking_m_s2 * stop) : 0.0;
    last = last < 0.25 ? 0.25 : last;
    looks.near(driver.allowed_speed_m_s(), last < v ? last : v, 1e-7);
    looks.near(driver.braking_to_m_s(s), std::sqrt(2.0 * config.braking_m_s2 * s), 1e-12);
    for (const double speed : {0.0, 4.0, 9.0}) {
      const double reach = 0.8 * speed < 2.5 ? 2.5 : 0.8 * speed > 5.0 ? 5.0 : 0.8 * speed;
      looks.near(driver.target_s_m(speed), s + reach < prior.route.length_m() ? s + reach : prior.route.length_m(),
                 1e-9);
    }
    const Vector2d target =
        p + Vector2d(drawn(-3, 3, 0, static_cast<int>(2.0 * s)), drawn(-3, 3, 1, static_cast<int>(2.0 * s)));
    const Vector2d d = seen_from(target, p, std::atan2(u.y(), u.x()));
    looks.near(driver.pursue(e, target),
               d.norm() < 0.5 ? 0.0
               : d.x() < 0.0  ? std::copysign(1.0, d.y())
                              : 2.0 * d.y() / d.squaredNorm(),
               1e-8);
  }
  e.X_WB.p = {40.0, 60.0, 0.0};
  e.v_WB_W.setZero();
  e.t = t + 1.0;
  looks.right(driver.update(e) && driver.done());
  return looks.figure();
}

/// An account of the way by wheel and heading alone, each look 2 cm unsure: an estimate that jumps aside is doubted
/// just where its square exceeds -2 ln(1e-4) times what estimates, way and course may err against more than half of the
/// looks before; doubt for 12 s is being lost, and one that comes back is believed. An estimate that says more than 5 m
/// of itself is doubted too.
StressFigure own_account(double heading_rad) {
  Looks looks;
  const auto make = [] {
    ModelChoice<self_checks> choice("own_motion");
    return model_row(self_checks(), "own_motion").make.make(choice.own);
  };
  const Vector2d u(std::cos(heading_rad), std::sin(heading_rad)), left(-u.y(), u.x());
  const GpsTime start = GpsTime::from_week_sow(1600, 0.0);
  const auto look = [&](SelfCheck& check, int k, double aside_m, double variance_m2) {
    if (k > 0) check.count({.t = start + 0.5 * k, .dt_s = 0.5, .ticks = 0, .speed_m_s = 3.2});
    NavEstimate e;
    e.t = start + 0.5 * k;
    e.X_WB.R = rotation_from({.yaw_rad = heading_rad, .pitch_rad = 0.0, .roll_rad = 0.0});
    const Vector2d p = 1.6 * k * u + aside_m * left;
    e.X_WB.p = {p.x() + 7.0, p.y() - 3.0, 1.0};
    e.v_WB_W = {3.2 * u.x(), 3.2 * u.y(), 0.0};
    e.pose_covariance.setZero();
    e.pose_covariance.diagonal().tail<3>().setConstant(variance_m2);
    check.see({}, e.X_WB, e);
  };
  for (const int before : {6, 11, 30}) {
    const int decisive = before / 2 + 1;  // looks back
    const double course = 0.01 * 1.6 * decisive;
    const double S = 2.0 * 0.25 + 4e-4 * decisive + course * course + 0.01;
    const double jump = std::sqrt(-2.0 * std::log(1e-4) * S);
    for (const double share : {0.995, 1.005}) {
      const auto check = make();
      for (int k = 0; k < before; ++k) look(*check, k, 0.0, 0.25);
      looks.right(check->trust() == Trust::kGood);
      look(*check, before, share * jump, 0.25);
      looks.right((check->trust() == Trust::kDoubtful) == (share > 1.0));
      if (share < 1.0) continue;
      looks.near(check->speed_limit_m_s(), 2.0, 1e-15);
      const auto other = make();
      for (int k = 0; k < before; ++k) look(*other, k, 0.0, 0.25);
      look(*other, before, 9.0, 0.25);
      look(*other, before + 1, 0.0, 0.25);
      looks.right(other->trust() == Trust::kGood);
      // Doubted for 12 s: 24 looks after the first.
      for (int k = 2; k <= 25; ++k) look(*other, before + k, 40.0, 0.25);
      looks.right(other->trust() == Trust::kDoubtful);
      look(*other, before + 26, 40.0, 0.25);
      looks.right(other->trust() == Trust::kLost);
    }
  }
  for (const double sigma_m : {4.9, 5.1}) {
    const auto check = make();
    look(*check, 0, 0.0, sigma_m * sigma_m);
    looks.right((check->trust() == Trust::kDoubtful) == (sigma_m > 5.0));
  }
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

std::vector<StressCase> plan_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "an autonomy's parts by themselves, turned, moved and at their limits",
           .why = "a body of the other end, a side exchanged, a cost or a limit of the wrong size, and the whole still "
                  "drives",
           .expected = "formulas and searches through everything, written out: roundings",
           .unit = "of the bound",
           .loose = "some bounds are those of the farthest of many places"});
  rows.add("plans/arcs", arcs)
      .add("plans/clearances", clearances)
      .add("plans/local_frames", local_frames)
      .add("plans/polar_ground", polar_ground)
      .add("plans/trackers", trackers_laws)
      .add("plans/speeds", speeds)
      .add("plans/driven_arcs", driven_arcs)
      .add("plans/cheapest_of_all", cheapest_plan)
      .add("plans/backing_up", backing_up)
      .add("plans/route_speeds", route_speeds)
      .add("plans/facades", facades);
  for (const double heading : {0.0, 2.2})
    rows.add("plans/own_account_heading_" + stress::text(heading), [heading] { return own_account(heading); });
  for (const double turn : {0.0, 1.0, -2.5})
    rows.add("plans/seen_street_turned_by_" + stress::text(turn), [turn] { return seen_street(turn); });
  for (const double yaw : {0.0, 0.02, -0.03})
    rows.add("plans/matched_walls_turned_by_" + stress::text(yaw), [yaw] { return matched_walls(yaw); });
  return rows.take();
}

}  // namespace canyon::mission
