#pragma once

#include <string>

#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/pvt_filter.h"
#include "canyon/gnss/solver/reported_covariance.h"
#include "canyon/gnss/solver/weighting.h"

namespace canyon::gnss {

/// Keys of how a receiver's ranges become positions.
struct PositionConfig {
  ModelChoice<position_solvers> solver{"least_squares"};
  ModelChoice<range_weightings> weighting{"elevation"};
  std::string raim = "none";  ///< a row of fault_exclusions()
  double raim_false_alarm = 1e-3;
  double solver_sigma_m = 0.5;  ///< assumed 1-sigma of a corrected pseudorange at zenith
  double max_gdop = 100.0;
  Estimator estimator = Estimator::kLeastSquares;
  double estimator_acceleration_m_s2 = 2.0;  ///< kalman: white acceleration per axis, m/s^2/sqrt(Hz)

  double smoothing_s = 0.0;  ///< time constant of carrier smoothing; 0 = off
  ModelChoice<reported_covariances> reported_covariance{"geometry"};
  std::int64_t fewest_satellites = 0;  ///< used in a fix; fewer: none
  double accuracy_limit_m = 0.0;       ///< 3-D 1-sigma reported; larger: no fix; 0 = no limit

  /// What the solver, and the least squares that begins a filter, are built from.
  PositionSolverParameters parameters() const;
};
void visit(FieldVisitor& f, PositionConfig& c);

}  // namespace canyon::gnss
