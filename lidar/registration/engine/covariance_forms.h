#pragma once

#include <span>

#include "canyon/core/model_table.h"
#include "canyon/lidar/registration/registration_covariance.h"

namespace canyon::lidar {

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
  bool restarts;      ///< needs them
  bool by_witnesses;  ///< widened by how few blocks tell of a direction (witnesses.h)
  bool by_noise;      ///< of points or of ranges: asks for their sums
};
ModelTable<CovarianceForm> covariance_forms();

}  // namespace canyon::lidar
