#pragma once

#include <span>

#include "canyon/core/model_table.h"
#include "canyon/lidar/registration/registration_covariance.h"

namespace canyon::lidar {

/// By how much the default form is above the sandwich, of variances: measured (docs/registration.md).
inline constexpr double kInflation = 1.5;

/// What a form of covariance is made from.
struct CovarianceCase {
  const CovarianceSums& sums;
  double point_sigma_m;  ///< 1-sigma of a point of either cloud, per axis
  double range_bias_m;   ///< 1-sigma of an error common to all ranges of a cloud
  /// Where registration ends from the 12 sigma points of the guess, as xi from its result; rows that ask for them.
  std::span<const Vector6d> restarts;
};

/// How sure a result is: the covariance of the gradient at the solution, B in A^-1 B A^-1 (registration_covariance.h).
struct CovarianceForm {
  Matrix6d (*gradient)(const CovarianceCase& of);
  bool restarts;  ///< needs them
};
ModelTable<CovarianceForm> covariance_forms();

}  // namespace canyon::lidar
