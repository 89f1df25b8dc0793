#pragma once

#include <Eigen/Core>

#include "canyon/core/config/config.h"

namespace canyon::fusion {

/// What lasts of the errors of the fixes' velocities: echoes shift the Doppler of what they add to for as long as they
/// are there, and a receiver's own filter holds on to it. The block `velocity_error` has its three states, without unit
/// and of variance 1, along E's axes; the measurement `velocity` says what they are to a fix.
struct VelocityErrorParameters {
  double velocity_error_scale = 0.5;
  double velocity_error_up_scale = 6.0;
  double velocity_error_tau_s = 2.0;

  /// What a velocity's error holds of the states, m/s: the symmetric root of scale^2 times the covariance that it
  /// states, m^2/s^2 in E, once that is stretched along `up_E`, of length 1.
  Eigen::Matrix3d share(const Eigen::Matrix3d& stated, const Eigen::Vector3d& up_E) const;
};
void visit(FieldVisitor& f, VelocityErrorParameters& p);

}  // namespace canyon::fusion
