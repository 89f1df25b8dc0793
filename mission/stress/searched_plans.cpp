// Plans that are searched for: the ways of a point that lead the search, and what a way is that it finds.
#include <cmath>
#include <cstddef>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/mission/autonomy/planning/search/free_ways.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/stress/autonomy_parts.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kEpsilon;
using stress::Looks;

/// Six posts of a metre across the way.
std::vector<Vector2d> posts(const RandomStream& draws, int k) {
  std::vector<Vector2d> cells;
  for (int i = 0; i < 6; ++i) {
    const Vector2d post(draws.uniform(13, 30, 0, 6 * k + i), draws.uniform(-5, 5, 1, 6 * k + i));
    for (double y = -0.5; y <= 0.5; y += 0.2) cells.push_back(post + Vector2d(0.0, y));
  }
  return cells;
}

/// From the last column back, each place asking all five of the next that it may go to; a straight route, so places are
/// plain coordinates. 22 columns of additions.
StressFigure free_ways() {
  Looks looks;
  const RandomStream draws(24, "stress.free_ways");
  const KnownVehicle vehicle;
  const ReferenceParameters defaults;
  const auto pursuit = model_row(trackers(), "pure_pursuit").make(defaults.tracker.model.own, vehicle);
  constexpr int kColumns = 23, kRows = 13;
  for (int k = 0; k < 20; ++k) {
    PlanParameters p;
    p.horizon_m = 11.0;
    const std::vector<Vector2d> cells = posts(draws, k);
    const BlockedCells blocked({15.0, 0.0}, cells);
    const Vector2d to_W(draws.uniform(-50, 50, 2, k), draws.uniform(-50, 50, 3, k));
    const Path route({to_W, to_W + Vector2d(60.0, 0.0)}, 8.0);
    const double lane_m = draws.uniform(-0.5, 0.5, 4, k);
    const PlanTask task{route, 12.0, to_W, lane_m, {{{12.0, lane_m}, 0.0}, 2.0, 0.0}, blocked, *pursuit, vehicle};
    const auto cost_1_m = [](const LanePlaces::Place& at) { return 0.1 + 0.03 * at.beside_m * at.beside_m; };
    const FreeWays ways(task, p, {-3.0, 3.0}, cost_1_m);
    std::vector<double> on(kRows, 0.0);
    for (int i = kColumns - 1; i >= 0; --i) {
      std::vector<double> here(kRows);
      for (int j = 0; j < kRows; ++j) {
        const double y = -3.0 + 0.5 * j;
        here[static_cast<std::size_t>(j)] = 4.0 * (11.0 - 0.5 * i) + 11.0 * (0.1 + 0.03 * y * y);
        for (int to = j - 2; to <= j + 2 && i < kColumns - 1; ++to) {
          if (to < 0 || to >= kRows) continue;
          const double next_y = -3.0 + 0.5 * to;
          bool free = true;
          for (const Vector2d& c : cells)
            free = free && (c - Vector2d(12.5 + 0.5 * i, lane_m + next_y)).norm() >= 0.75 + 0.3 - 0.25;
          const double by = 0.25 * (0.2 + 0.03 * (y * y + next_y * next_y)) + on[static_cast<std::size_t>(to)];
          if (free && by < here[static_cast<std::size_t>(j)]) here[static_cast<std::size_t>(j)] = by;
        }
        looks.near(ways.cost({12.0 + 0.5 * i, y}), here[static_cast<std::size_t>(j)], 64.0 * kEpsilon * 60.0);
      }
      on = here;
    }
  }
  return looks.figure();
}

/// A way's points lie a step of its arcs apart, less what a chord is shorter, (kappa d)^2 d / 24 at most; it turns no
/// more than the vehicle can; and what is told of it is what driving it in thought says.
StressFigure searched_ways() {
  Looks looks;
  const RandomStream draws(25, "stress.searched_ways");
  const KnownVehicle vehicle;
  const ReferenceParameters defaults;
  const auto pursuit = model_row(trackers(), "pure_pursuit").make(defaults.tracker.model.own, vehicle);
  const double most_1_m = std::tan(vehicle.max_steering_rad) / vehicle.wheelbase_m, step_m = DrivenArc::kStep_m;
  for (int k = 0; k < 12; ++k) {
    const auto planner = model_row(local_planners(), "hybrid_a_star").make(defaults.planner.model.own);
    const BlockedCells blocked({15.0, 0.0}, posts(draws, k));
    const Path route({{0.0, 0.0}, {60.0, 0.0}}, 8.0);
    const MovingBody body{{{6.0, draws.uniform(-1, 1, 2, k)}, draws.uniform(-0.2, 0.2, 3, k)}, 2.5, 0.0};
    const PlanTask task{route, 6.0, Vector2d::Zero(), 0.0, body, blocked, *pursuit, vehicle};
    const LocalPlan plan = planner->plan(task);
    const std::vector<Vector2d>& way = plan.line.points_O;
    looks.right(way.size() > 24 && way.front() == body.pose.p_m);
    // The first arc at least; what was driven may end after it, and goes on beside the lane.
    double heading = body.pose.yaw_rad;
    for (std::size_t i = 1; i <= 6; ++i) {
      const Vector2d d = way[i] - way[i - 1];
      const double turned = most_1_m * step_m;
      looks.near(d.norm(), step_m, step_m * turned * turned / 24.0 + 64.0 * kEpsilon);
      looks.right(std::abs(std::atan2(d.y(), d.x()) - heading) <= turned + 1e-12);
      heading = std::atan2(d.y(), d.x());
    }
    const DrivenArc again = drive_in_thought(plan.line, body, 22.0, planner->clearances(), *pursuit, blocked, vehicle);
    looks.right(plan.arc.free_m >= again.free_m && plan.arc.curvature_1_m.size() >= again.curvature_1_m.size());
    // As far as it is free, nothing is nearer than what is asked for, or than it was at the beginning.
    PlanPose pose = body.pose;
    for (const float kappa : plan.arc.curvature_1_m) {
      pose = pose.along(static_cast<double>(kappa), step_m);
      looks.right(blocked.clearance_m(pose, vehicle, 1.0) >= 0.3 - 1e-6);  // a curvature in single precision
    }
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> searched_plan_cases() {
  StressRows rows;
  rows.of(autonomy_part());
  rows.add("plans/free_ways", free_ways).add("plans/searched_ways", searched_ways);
  return rows.take();
}

}  // namespace canyon::mission
