#pragma once

#include <Eigen/Core>

#include "canyon/fusion/calibration.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// Linearization of one strapdown step: x = [theta, p, v] after it, from x before it and the errors e of the IMU's raw
/// output (gyroscope rad/s, accelerometer m/s^2; measured minus true) during it, which enter by their integrals I_1 (of
/// e), I_2 (of I_1) and I_3 (of I_2) over the step:
///   theta+ = theta_theta theta + theta_gyro I_1g
///   v+     = v_theta theta + v_p p + v_v v + v_accel I_1a + v_gyro I_2g
///   p+     = p + (v + v+) dt / 2 + v_accel (I_2a - dt / 2 I_1a) + v_gyro (I_3g - dt / 2 I_2g)
/// The increments' gain errors K_hat are taken out of e by (I + K_hat)^-1, which the last three matrices hold.
struct StepJacobian {
  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

  double dt_s = 0.0;
  Matrix theta_theta, theta_gyro;
  Matrix v_theta, v_p, v_v, v_accel, v_gyro;

  /// `before`: state at the start of the interval; `in`: increments fed in; `gravity_gradient`: in E, at `before`.
  StepJacobian(const NavState& before, const Increments& in, const Calibration& imu,
               const Eigen::Matrix3d& gravity_gradient);
  /// The same in axes that do not turn and in which nothing falls, to which U is turned by `R_start` at the start.
  StepJacobian(const Eigen::Quaterniond& R_start, const Increments& in, const Calibration& imu);

 private:
  void set_imu(const Eigen::Matrix3d& R, const Increments& in, const Calibration& imu);
};

}  // namespace canyon::fusion
