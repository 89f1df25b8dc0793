#include "canyon/fusion/propagation/step_jacobian.h"

#include <cmath>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

/// R [v]x: its rows are those of R, each crossed with v.
Eigen::Matrix3d times_skew(const Eigen::Matrix3d& R, const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  for (int i = 0; i < 3; ++i) out.row(i) = Eigen::Vector3d(R.row(i)).cross(v);
  return out;
}

}  // namespace

StepJacobian::StepJacobian(const NavState& before, const Increments& in, const Calibration& imu,
                           const Eigen::Matrix3d& gravity_gradient)
    : dt_s(in.dt_s) {
  // E turns about its third axis alone, so that its matrices have two numbers each. Force: turned by half of that turn,
  // and seen again in the Coriolis term's mid-interval velocity.
  const double turn = dt_s * Wgs84::rate_rad_s, c = std::cos(0.5 * turn), s = std::sin(0.5 * turn);
  const double along = c - turn * s, across = s + turn * c;
  const Eigen::Matrix3d R = before.R_EU.toRotationMatrix();
  Eigen::Matrix3d turned;
  turned.row(0) = along * R.row(0) + across * R.row(1);
  turned.row(1) = along * R.row(1) - across * R.row(0);
  turned.row(2) = R.row(2);
  set_imu(turned, in, imu);
  v_p = dt_s * gravity_gradient;
  // 1 - 2 dt [w]x + 2 dt^2 [w]x^2, and half of what the gradient does.
  v_v = (0.5 * dt_s) * v_p;
  const double coriolis = 2.0 * turn, twice = 1.0 - 2.0 * turn * turn;
  v_v(0, 0) += twice;
  v_v(0, 1) += coriolis;
  v_v(1, 0) -= coriolis;
  v_v(1, 1) += twice;
  v_v(2, 2) += 1.0;
}

StepJacobian::StepJacobian(const Eigen::Quaterniond& R_start, const Increments& in, const Calibration& imu)
    : dt_s(in.dt_s) {
  set_imu(R_start.toRotationMatrix(), in, imu);
  v_v.setIdentity();
  v_p.setZero();
}

void StepJacobian::set_imu(const Eigen::Matrix3d& R, const Increments& in, const Calibration& imu) {
  theta_theta = so3_exp(-in.dtheta_U).toRotationMatrix();
  theta_gyro = -so3_right_jacobian(in.dtheta_U).lazyProduct(imu.gyro_inverse);
  v_theta = -times_skew(R, in.dv_U + 0.5 * in.dtheta_U.cross(in.dv_U));
  v_accel = -(R + times_skew(R, 0.5 * in.dtheta_U)).lazyProduct(imu.accel_inverse);
  v_gyro = times_skew(R, in.dv_U / dt_s).lazyProduct(imu.gyro_inverse);
}

}  // namespace canyon::fusion
