#pragma once

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// The motion of the IMU at an instant, as the measurements before and after it tell it together.
struct SmoothedState {
  NavState nav;
  Eigen::Vector3d w_EU_U = Eigen::Vector3d::Zero();        ///< angular rate, rad/s
  Eigen::Vector3d gyro_bias_U = Eigen::Vector3d::Zero();   ///< rad/s
  Eigen::Vector3d accel_bias_U = Eigen::Vector3d::Zero();  ///< m/s^2
  /// Of [theta, p, v]: right perturbation of R_EU, rad; p, v in E, m and m/s. Truth minus estimate.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
};

/// The same of the body B, whose IMU is at `lever_U_B` (in B, m), in the filter's terms. What is not known of the
/// gyroscopes' biases is left out of the velocity's covariance: times the lever arm, 0.1 mm/s for 1e-4 rad/s and a
/// metre.
NavEstimate estimate_of(const SmoothedState& state, const LocalFrame& frame, const Eigen::Vector3d& lever_U_B);

}  // namespace canyon::fusion
