#pragma once

#include "gnss/solver/position_solver.h"

namespace canyon::gnss {

/// The iteration that both solvers share: Gauss-Newton on weighted ranges, with the Sagnac turn of every satellite
/// recomputed from the current range. `clock`: a fourth unknown, the receiver clock.
PositionSolution solve_ranges(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E, bool clock,
                              const PositionSolverParameters& p);

}  // namespace canyon::gnss
