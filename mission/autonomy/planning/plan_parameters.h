#pragma once

#include "canyon/core/config/config.h"

namespace canyon::mission {

/// What the planners weigh a way by. All of them read the same keys, so that they can be held beside one another.
struct PlanParameters {
  double horizon_m = 22.0;
  double max_offset_m = 3.5;
  double clearance_m = 0.3;
  double comfort_clearance_m = 0.8;
  double blocked_cost_1_m = 4.0;
  double closeness_cost_1_m2 = 1.0;
  double offset_cost_1_m = 0.6;
  double change_share = 0.5;
  double turning_cost_m = 5.0;
};
void visit(FieldVisitor& f, PlanParameters& p);

/// Of a way that is not free to its end, on which it takes `halting_m` to halt: more than all else together. Nothing is
/// worse than to touch a thing before, and then to come too near to one.
double crash_cost(double halting_m, double free_m, double untouched_m);
/// Of a line after the horizon, for the tracker to look at.
inline constexpr double kBeyondHorizon_m = 6.0;

/// How far beside the lane's middle ways are looked for, left positive. Of a vehicle that is farther beside it than
/// max_offset_m these are also the ways where it is, however far: the lane is then where an estimate puts it that may
/// be wrong by as much, and what is seen is not.
struct OffsetRange {
  double right_m, left_m;
};
OffsetRange offset_range(const PlanParameters& p, double here_m);

}  // namespace canyon::mission
