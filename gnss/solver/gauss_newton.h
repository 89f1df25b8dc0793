#pragma once

#include <vector>

#include "canyon/gnss/solver/position_solver.h"

namespace canyon::gnss {

/// What the iteration finds. Vectors run parallel to the ranges that were fitted.
struct RangeFit {
  bool ok = false;
  std::string reason;
  Eigen::Vector3d p_E = Eigen::Vector3d::Constant(kNaN);
  std::vector<double> clock_m;  ///< in the order of ReceiverClocks; empty without clocks
  double shared = 0.0;          ///< the shared error, in its sigmas
  Eigen::Matrix3d covariance_E = Eigen::Matrix3d::Constant(kNaN);
  Dop dop;
  std::vector<double> residuals_m;
  std::vector<double> weighted;  ///< residual / sigma
  /// Part of a range's own variance that its residual keeps, 0..1: 0 = the fit follows the range, whatever it says.
  std::vector<double> redundancy;
  double range_gain = kNaN;  ///< sum over the ranges of |d p_E / d range|
  double statistic = kNaN;   ///< sum of (residual / sigma)^2, with the prior of the shared error
  int degrees_of_freedom = 0;
  int iterations = 0;
};

/// The iteration that both solvers share: Gauss-Newton on weighted ranges, with the Sagnac turn of every satellite
/// recomputed from the current range. `clocks`: with unknowns for the receiver clocks of the systems in `ranges`.
RangeFit fit_ranges(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E, bool clocks,
                    double max_gdop);

/// Distance from p_E, at reception, to the satellite of a range, and the unit vector there.
struct LineOfSight {
  double range_m;
  Eigen::Vector3d line;
};
LineOfSight line_of_sight(const Eigen::Vector3d& satellite_E, const Eigen::Vector3d& p_E);

}  // namespace canyon::gnss
