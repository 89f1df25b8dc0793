#pragma once

#include <Eigen/Core>

#include "canyon/core/config/config.h"

namespace canyon::fusion {

/// What lasts of the errors of fixes, as reflections make it: how large it is, and over what time and way it changes.
/// The block `fix_error` has its three states, the measurement `position` says what they are to a fix.
struct FixErrorParameters {
  double fix_error_sigma_m = 0.3;
  double fix_error_scale = 1.5;
  double fix_error_power = 1.5;
  double fix_error_tau_s = 20.0;
  double fix_error_way_m = 1e9;

  /// Its covariance, m^2, in a fix that states the covariance `stated`: sigma^2 on each axis, and along the axes of
  /// what is stated the square of scale times its 1-sigma, m, to that power.
  Eigen::Matrix3d covariance(const Eigen::Matrix3d& stated) const;
  /// What a fix's error holds of the states, which are m in a fix of no stated error: the root of covariance() over
  /// sigma that is symmetric, so that it changes as little as the covariance does; the identity where scale is 0.
  Eigen::Matrix3d share(const Eigen::Matrix3d& stated) const;
};
void visit(FieldVisitor& f, FixErrorParameters& p);

}  // namespace canyon::fusion
