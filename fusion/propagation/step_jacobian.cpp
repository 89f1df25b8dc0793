#include "canyon/fusion/propagation/step_jacobian.h"

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {

StepJacobian::StepJacobian(const NavState& before, const Increments& in, const Calibration& imu,
                           const Eigen::Matrix3d& gravity_gradient)
    : dt_s(in.dt_s) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d earth = skew(earth_rate_E());
  // Force: turned by half of E's own turn, and seen again in the Coriolis term's mid-interval velocity.
  const Eigen::Matrix3d half_turn = so3_exp(-0.5 * dt_s * earth_rate_E()).toRotationMatrix();
  set_imu((one - dt_s * earth) * half_turn * before.R_EU.toRotationMatrix(), in, imu);
  v_v = one - 2.0 * dt_s * earth + (2.0 * dt_s * dt_s) * earth * earth + (0.5 * dt_s * dt_s) * gravity_gradient;
  v_p = dt_s * gravity_gradient;
}

StepJacobian::StepJacobian(const Eigen::Quaterniond& R_start, const Increments& in, const Calibration& imu)
    : dt_s(in.dt_s) {
  set_imu(R_start.toRotationMatrix(), in, imu);
  v_v.setIdentity();
  v_p.setZero();
}

void StepJacobian::set_imu(const Eigen::Matrix3d& R, const Increments& in, const Calibration& imu) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  theta_theta = so3_exp(-in.dtheta_U).toRotationMatrix();
  theta_gyro = -so3_right_jacobian(in.dtheta_U) * imu.gyro_inverse;
  v_theta = -R * skew(in.dv_U + 0.5 * in.dtheta_U.cross(in.dv_U));
  v_accel = -R * (one + 0.5 * skew(in.dtheta_U)) * imu.accel_inverse;
  v_gyro = R * skew(in.dv_U / dt_s) * imu.gyro_inverse;
}

}  // namespace canyon::fusion
