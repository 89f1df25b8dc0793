#include "canyon/fusion/calibration.h"

#include <Eigen/LU>

namespace canyon::fusion {

void Calibration::set_gains(const Eigen::Matrix3d& gyro, const Eigen::Matrix3d& accel) {
  if (gyro == gyro_gain && accel == accel_gain) return;
  gyro_gain = gyro;
  accel_gain = accel;
  gyro_inverse = (Eigen::Matrix3d::Identity() + gyro).inverse();
  accel_inverse = (Eigen::Matrix3d::Identity() + accel).inverse();
}

Increments Calibration::apply(double dt_s, const Eigen::Vector3d& dtheta_raw, const Eigen::Vector3d& dv_raw) const {
  return {.dt_s = dt_s,
          .dtheta_U = gyro_inverse * (dtheta_raw - dt_s * gyro_bias),
          .dv_U = accel_inverse * (dv_raw - dt_s * accel_bias)};
}

}  // namespace canyon::fusion
