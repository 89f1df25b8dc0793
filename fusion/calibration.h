#pragma once

#include <Eigen/Core>

#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// What the filter knows of the IMU's errors: biases and gain errors K, taken out of raw increments.
struct Calibration {
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< rad/s
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< m/s^2
  Eigen::Matrix3d gyro_gain = Eigen::Matrix3d::Zero(), accel_gain = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d gyro_inverse = Eigen::Matrix3d::Identity(), accel_inverse = Eigen::Matrix3d::Identity();

  /// Sets the gain errors and, if they are others, with them the inverses (I + K)^-1.
  void set_gains(const Eigen::Matrix3d& gyro, const Eigen::Matrix3d& accel);
  /// (I + K)^-1 (raw - bias dt).
  Increments apply(double dt_s, const Eigen::Vector3d& dtheta_raw, const Eigen::Vector3d& dv_raw) const;
};

}  // namespace canyon::fusion
