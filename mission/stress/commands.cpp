// What an autonomy commands: curvature by its trackers, speed by its rules and by the route, and backing up.
#include <cmath>
#include <cstddef>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/autonomy/known_vehicle.h"
#include "canyon/mission/autonomy/path.h"
#include "canyon/mission/autonomy/perception/blocked_cells.h"
#include "canyon/mission/autonomy/planning/driven_arc.h"
#include "canyon/mission/autonomy/planning/plan_line.h"
#include "canyon/mission/autonomy/planning/recovery.h"
#include "canyon/mission/autonomy/planning/speed_rule.h"
#include "canyon/mission/autonomy/planning/tracker.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/autonomy/route_driver.h"
#include "canyon/mission/stress/autonomy_parts.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kInfinity;
using stress::Looks;

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
  const RandomStream draws(15, "stress.plans");
  KnownVehicle vehicle;
  const ReferenceParameters defaults;
  const auto pursuit = model_row(trackers(), "pure_pursuit").make(defaults.tracker.model.own, vehicle);
  ModelChoice<trackers> second("stanley");
  const auto stanley = model_row(trackers(), "stanley").make(second.own, vehicle);
  const PlanLine line = winding();
  for (int k = 0; k < 300; ++k) {
    const auto i = static_cast<std::size_t>(k % 110);
    const double yaw = std::atan2(line.direction(i).y(), line.direction(i).x()) + draws.uniform(-0.5, 0.5, 0, k);
    const PlanPose body{line.at(i) + Vector2d(draws.uniform(-1, 1, 1, k), draws.uniform(-1, 1, 2, k)), yaw};
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
    const double now = draws.uniform(-0.55, 0.55, 5, k), kappa = draws.uniform(-0.6, 0.6, 6, k),
                 dt_s = draws.uniform(0.001, 0.8, 7, k);
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
  const RandomStream draws(15, "stress.plans");
  const auto rule = model_row(speed_rules(), "stopping_distance").make(ReferenceParameters{}.speed.model.own);
  for (int k = 0; k < 400; ++k) {
    SpeedTask task;
    task.route_m_s = draws.uniform(0.5, 14, 0, k);
    task.free_to_end = k % 3 == 0;
    task.free_m = draws.uniform(0.0, 30, 1, k);
    task.seen_m = draws.uniform(0.0, 40, 2, k);
    task.braking_m_s2 = draws.uniform(0.5, 3, 3, k);
    task.lateral_m_s2 = draws.uniform(0.5, 3, 4, k);
    std::vector<float> bends;
    for (int i = 0; i < 60; ++i)
      bends.push_back(static_cast<float>(i % 20 == 7 ? draws.uniform(-0.5, 0.5, 5, 64 * k + i) : 0.0));
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

/// Cruise, bends and stops on a route with one corner: each by its formula; waypoints one after another.
StressFigure route_speeds() {
  Looks looks;
  const RandomStream draws(15, "stress.plans");
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
    const Vector2d target = p + Vector2d(draws.uniform(-3, 3, 0, static_cast<int>(2.0 * s)),
                                         draws.uniform(-3, 3, 1, static_cast<int>(2.0 * s)));
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

}  // namespace

std::vector<StressCase> command_cases() {
  StressRows rows;
  rows.of(autonomy_part());
  rows.add("commands/trackers", trackers_laws)
      .add("commands/speeds", speeds)
      .add("commands/backing_up", backing_up)
      .add("commands/route_speeds", route_speeds);
  return rows.take();
}

}  // namespace canyon::mission
