#include "canyon/mission/autonomy/planning/plan_parameters.h"

#include <algorithm>
#include <cmath>

namespace canyon::mission {

void visit(FieldVisitor& f, PlanParameters& p) {
  f.number("horizon_m", p.horizon_m, {5, 60}, "how far ahead it plans");
  f.number("max_offset_m", p.max_offset_m, {0, 20}, "how far beside the middle of its lane it may go");
  f.number("clearance_m", p.clearance_m, {0.05, 3}, "from the body's outline to the middle of a blocked cell");
  f.number("comfort_clearance_m", p.comfort_clearance_m, {0, 5}, "nearer than this costs");
  f.number("blocked_cost_1_m", p.blocked_cost_1_m, {0, 1e3}, "cost of every metre of the horizon after an obstacle");
  f.number("closeness_cost_1_m2", p.closeness_cost_1_m2, {0, 1e3},
           "cost of every metre driven one metre nearer than comfortable");
  f.number(
      "offset_cost_1_m", p.offset_cost_1_m, {0.01, 1e3},
      "cost of every metre that the end of a way lies beside the lane's middle, with hybrid_a_star also of its mean");
  f.number("change_share", p.change_share, {0, 0.95},
           "cost of every metre beside the way chosen last, as a share of offset_cost_1_m; less than 1, so that going "
           "back to the lane always pays");
  f.number("turning_cost_m", p.turning_cost_m, {0, 1e3},
           "cost of the squared curvature beside the route's own, per metre driven");
}

double crash_cost(double halting_m, double free_m, double untouched_m) {
  constexpr double kTooNear_1_m = 100.0, kTouched_1_m = 1000.0;
  return kTooNear_1_m * std::max(0.0, halting_m - free_m) + kTouched_1_m * std::max(0.0, halting_m - untouched_m);
}

OffsetRange offset_range(const PlanParameters& p, double here_m) {
  constexpr double kTowardsTheLane_m = 20.0;  // of a vehicle that is even farther off
  const double usual = p.max_offset_m, beside = std::abs(here_m);
  if (beside <= usual) return {-usual, usual};
  const double near = std::max(-usual, beside - kTowardsTheLane_m - usual), far = beside + usual;
  return here_m > 0.0 ? OffsetRange{near, far} : OffsetRange{-far, -near};
}

}  // namespace canyon::mission
