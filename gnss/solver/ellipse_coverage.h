#pragma once

#include <vector>

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// How honest the horizontal covariances of fixes are: shares of errors inside the ellipses that hold 50, 95 and 99.7 %
/// of a normal distribution with the covariance that came with the fix, and the mean logarithm of its density at the
/// error (per square metre). What has no covariance does not count. NaN where nothing was added.
class EllipseCoverage {
 public:
  /// error_enu_m and the covariance in east, north, up; of both the horizontal part counts.
  void add(const Eigen::Vector3d& error_enu_m, const Eigen::Matrix3d& covariance_enu_m2);
  /// A fix and where the antenna truly was.
  void add(const GnssFix& fix, const Eigen::Vector3d& true_E);

  std::size_t count() const { return squares_.size(); }
  /// Share of errors inside the ellipse that should hold `share` of them, 0..1.
  double inside(double share) const;
  double beyond_3_sigma() const { return count() > 0 ? 1.0 - inside_square(9.0) : kNaN; }
  double log_score() const;

 private:
  double inside_square(double square) const;
  std::vector<double> squares_;  ///< of the error in its own sigmas
  double log_sum_ = 0.0;
};

}  // namespace canyon::gnss
