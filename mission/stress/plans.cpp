// Plans of an autonomy: arcs, what they keep clear of, how far they can be driven, and the cheapest of all.
#include <cmath>
#include <cstddef>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/mission/autonomy/known_vehicle.h"
#include "canyon/mission/autonomy/path.h"
#include "canyon/mission/autonomy/perception/blocked_cells.h"
#include "canyon/mission/autonomy/planning/driven_arc.h"
#include "canyon/mission/autonomy/planning/local_planner.h"
#include "canyon/mission/autonomy/planning/plan_line.h"
#include "canyon/mission/autonomy/planning/tracker.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/stress/autonomy_parts.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

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
  const RandomStream draws(15, "stress.plans");
  KnownVehicle vehicle;
  vehicle.rear_m = -0.7;
  const Vector2d centre(11.0, -23.0);
  std::vector<Vector2d> cells;
  for (int k = 0; k < 900; ++k)
    cells.emplace_back(centre.x() + draws.uniform(-70, 70, 0, k), centre.y() + draws.uniform(-70, 70, 1, k));
  const BlockedCells blocked(centre, cells);
  std::size_t within = 0;
  for (const Vector2d& c : cells)
    within += std::abs(c.x() - centre.x()) < 64.0 && std::abs(c.y() - centre.y()) < 64.0 ? 1 : 0;
  looks.right(blocked.all().size() == within);
  for (int k = 0; k < 400; ++k) {
    const PlanPose body{{centre.x() + draws.uniform(-80, 80, 2, k), centre.y() + draws.uniform(-80, 80, 3, k)},
                        draws.uniform(-4, 4, 4, k)};
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
  // A body that already stands too near goes on where it comes no nearer, after two metres a little less near with
  // every metre.
  std::vector<Vector2d> wall;
  for (double x = -5.0; x < 60.0; x += 0.2) wall.emplace_back(x, 0.95);
  const BlockedCells near({0.0, 0.0}, wall);
  looks.near(free_along({{0.0, 0.0}, 0.0}, 0.0, 10.0, {}, near, vehicle), 2.0 + 0.25 * std::floor(0.05 / 0.1 / 0.25),
             1e-12);
  return looks.figure();
}

/// The plan that is chosen is the cheapest of all lines that could be: each laid out and driven here.
StressFigure cheapest_plan() {
  Looks looks;
  const RandomStream draws(15, "stress.plans");
  const KnownVehicle vehicle;
  const ReferenceParameters defaults;
  const auto pursuit = model_row(trackers(), "pure_pursuit").make(defaults.tracker.model.own, vehicle);
  for (int k = 0; k < 12; ++k) {
    const auto planner = model_row(local_planners(), "offsets").make(defaults.planner.model.own);
    const Vector2d to_W(draws.uniform(-5, 5, 0, k), draws.uniform(-5, 5, 1, k));
    const Path route({to_W, to_W + Vector2d(30.0, 0.0), to_W + Vector2d(52.0, 12.0 + k)}, 8.0);
    std::vector<Vector2d> cells;
    for (int i = 0; i < 6; ++i) {
      const Vector2d post(draws.uniform(14, 34, 2, 8 * k + i), draws.uniform(-5, 5, 3, 8 * k + i));
      for (double y = -0.4; y <= 0.4; y += 0.2) cells.push_back(post + Vector2d(0.0, y));
    }
    const BlockedCells blocked({10.0, 0.0}, cells);
    const double lane_m = draws.uniform(-0.5, 0.5, 4, k);
    double chosen_m = 0.0;
    for (const double x : {6.0, 9.0}) {
      const MovingBody body{{{x, draws.uniform(-1, 1, 5, k)}, draws.uniform(-0.1, 0.1, 6, k)}, 3.0, 0.05};
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

}  // namespace

std::vector<StressCase> plan_cases() {
  StressRows rows;
  rows.of(autonomy_part());
  rows.add("plans/arcs", arcs)
      .add("plans/clearances", clearances)
      .add("plans/driven_arcs", driven_arcs)
      .add("plans/cheapest_of_all", cheapest_plan);
  return rows.take();
}

}  // namespace canyon::mission
