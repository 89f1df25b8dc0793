#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/inertial/motion/series.h"

namespace canyon::inertial {

/// Natural spline of fifth degree through values at increasing times, several columns at once: of all functions through
/// them the one of the least integral of the squared third derivative, four times continuously differentiable.
///
/// With `smoothing_s` > 0 it need not pass through the values, and minimizes sum (y - s)^2 + lambda integral (s''')^2
/// (Reinsch 1967), lambda such that of an oscillation of period smoothing_s in evenly spaced values half is left; of
/// twice that period 98.5 %, of half of it 1.5 %.
class QuinticSpline {
 public:
  /// At least three times, in seconds; one row of `values` each.
  QuinticSpline(std::vector<double> t_s, const Eigen::MatrixXd& values, double smoothing_s = 0.0);

  double first_s() const { return t_s_.front(); }
  double last_s() const { return t_s_.back(); }
  /// Column j at t; outside [first, last] the end polynomials go on.
  Series at(double t_s, Eigen::Index j) const;

 private:
  std::vector<double> t_s_;
  Eigen::MatrixXd states_;  ///< rows 3 i to 3 i + 2: value and first two derivatives at time i
};

}  // namespace canyon::inertial
