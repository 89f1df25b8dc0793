#include "fusion/error_propagation.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "core/earth.h"
#include "core/rotation.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
template <int Rows, int Columns>
using RowMatrix = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;
using Row3 = RowMatrix<3, 3>;

constexpr int kMoving = 9;  // theta, p, v

/// x+ from x and z, for any number of columns at once.
template <int Columns>
RowMatrix<kMoving, Columns> apply(const StepJacobian& s, const RowMatrix<kMoving, Columns>& x,
                                  const RowMatrix<6, Columns>& z) {
  const RowMatrix<3, Columns> theta = x.template topRows<3>();
  const RowMatrix<3, Columns> p = x.template middleRows<3>(3);
  const RowMatrix<3, Columns> v = x.template bottomRows<3>();
  const RowMatrix<3, Columns> zg = z.template topRows<3>();
  const RowMatrix<3, Columns> za = z.template bottomRows<3>();
  RowMatrix<3, Columns> v_next = s.v_v.lazyProduct(v);
  v_next += s.v_p.lazyProduct(p);
  v_next += s.v_theta.lazyProduct(theta);
  v_next += s.v_zg.lazyProduct(zg);
  v_next += s.v_za.lazyProduct(za);
  RowMatrix<kMoving, Columns> next;
  next.template topRows<3>() = s.theta_theta.lazyProduct(theta);
  next.template topRows<3>() += s.theta_zg.lazyProduct(zg);
  next.template middleRows<3>(3) = p + (0.5 * s.dt_s) * (v + v_next);
  next.template bottomRows<3>() = v_next;
  return next;
}

/// Rows z = E y for rows y of the parameters [b_g, b_a, K_g, K_a] (or only the biases): the error of an increment is
/// -(I + K_hat)^-1 (b dt + K increment).
template <int Parameters, int Columns>
RowMatrix<6, Columns> increment_errors(const RowMatrix<Parameters, Columns>& y, const Increments& in,
                                       const Calibration& c) {
  RowMatrix<6, Columns> raw;
  raw.template topRows<3>() = in.dt_s * y.template topRows<3>();
  raw.template bottomRows<3>() = in.dt_s * y.template middleRows<3>(3);
  if constexpr (Parameters > 6) {
    for (int i = 0; i < 3; ++i) {
      const int g = 6 + 3 * i, a = 15 + 3 * i;
      raw.row(i) += in.dtheta_U.x() * y.row(g) + in.dtheta_U.y() * y.row(g + 1) + in.dtheta_U.z() * y.row(g + 2);
      raw.row(3 + i) += in.dv_U.x() * y.row(a) + in.dv_U.y() * y.row(a + 1) + in.dv_U.z() * y.row(a + 2);
    }
    if (c.gyro_gain.isZero(0.0) && c.accel_gain.isZero(0.0)) return -raw;
    const Eigen::Matrix3d gyro = -(Eigen::Matrix3d::Identity() + c.gyro_gain).inverse();
    const Eigen::Matrix3d accel = -(Eigen::Matrix3d::Identity() + c.accel_gain).inverse();
    RowMatrix<6, Columns> z;
    z.template topRows<3>() = gyro.lazyProduct(raw.template topRows<3>());
    z.template bottomRows<3>() = accel.lazyProduct(raw.template bottomRows<3>());
    return z;
  } else {
    return -raw;
  }
}

template <int Parameters>
void propagate(ErrorMatrix& P, const StepJacobian& step, const Increments& in, const Calibration& c) {
  // Covariance of [x; z] before the step, z being the part of the increments' error that the parameters make.
  const RowMatrix<kMoving, Parameters> P_xy = P.template block<kMoving, Parameters>(0, kMoving);
  const RowMatrix<Parameters, Parameters> P_yy = P.template block<Parameters, Parameters>(kMoving, kMoving);
  const RowMatrix<Parameters, kMoving> P_yx = P_xy.transpose();
  const RowMatrix<6, Parameters> P_zy = increment_errors<Parameters, Parameters>(P_yy, in, c);
  const RowMatrix<6, kMoving> P_zx = increment_errors<Parameters, kMoving>(P_yx, in, c);
  const RowMatrix<Parameters, 6> P_yz = P_zy.transpose();
  const RowMatrix<6, 6> P_zz = increment_errors<Parameters, 6>(P_yz, in, c);

  RowMatrix<kMoving, 15> top;  // [P_xx, P_xz]
  top << P.template topLeftCorner<kMoving, kMoving>(), P_zx.transpose();
  RowMatrix<6, 15> bottom;
  bottom << P_zx, P_zz;
  const RowMatrix<kMoving, 15> left = apply<15>(step, top, bottom);
  const RowMatrix<kMoving, kMoving> left_x = left.template leftCols<kMoving>().transpose();
  const RowMatrix<6, kMoving> left_z = left.template rightCols<6>().transpose();
  const RowMatrix<kMoving, kMoving> P_xx = apply<kMoving>(step, left_x, left_z);
  const RowMatrix<kMoving, Parameters> P_xy_next = apply<Parameters>(step, P_xy, P_zy);

  P.template topLeftCorner<kMoving, kMoving>() = 0.5 * (P_xx + P_xx.transpose());
  P.template block<kMoving, Parameters>(0, kMoving) = P_xy_next;
  P.template block<Parameters, kMoving>(kMoving, 0) = P_xy_next.transpose();
}

/// White noise enters half before and half after the step: its effect through the step is then right to second order.
void add_half_white(ErrorMatrix& P, const ImuNoise& noise, double dt_s) {
  const double theta = 0.5 * dt_s * noise.gyro.white_per_sqrt_hz * noise.gyro.white_per_sqrt_hz;
  const double v = 0.5 * dt_s * noise.accel.white_per_sqrt_hz * noise.accel.white_per_sqrt_hz;
  for (int i = 0; i < 3; ++i) {
    P(Index::kTheta + i, Index::kTheta + i) += theta;
    P(Index::kVelocity + i, Index::kVelocity + i) += v;
  }
}

void decay_bias(ErrorMatrix& P, int first, const BiasModel& model, double dt_s) {
  const double decay = model.decay(dt_s);
  if (decay != 1.0) {
    P.middleRows<3>(first) *= decay;
    P.middleCols<3>(first) *= decay;
  }
  const double added = model.added_variance(dt_s);
  for (int i = 0; i < 3; ++i) P(first + i, first + i) += added;
}

}  // namespace

BiasModel::BiasModel(const TriadNoise& noise) {
  const double constant = noise.turn_on_bias_sigma * noise.turn_on_bias_sigma;
  const double in_run = noise.in_run_bias_sigma * noise.in_run_bias_sigma;
  sigma = std::sqrt(constant + in_run);
  tau_s =
      in_run > 0.0 ? noise.in_run_bias_tau_s * (constant + in_run) / in_run : std::numeric_limits<double>::infinity();
}

double BiasModel::decay(double dt_s) const {
  return std::exp(-dt_s / tau_s);
}

double BiasModel::added_variance(double dt_s) const {
  return -sigma * sigma * std::expm1(-2.0 * dt_s / tau_s);
}

StepJacobian::StepJacobian(const NavState& before, const Increments& in, const Eigen::Matrix3d& gravity_gradient)
    : dt_s(in.dt_s) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d earth = skew(earth_rate_E());
  const Eigen::Matrix3d turn = skew(in.dtheta_U);
  const Eigen::Matrix3d push = skew(in.dv_U);

  theta_theta = so3_exp(-in.dtheta_U).toRotationMatrix();
  theta_zg = so3_right_jacobian(in.dtheta_U);

  // Force: turned by half of E's own turn, and seen again in the Coriolis term's mid-interval velocity.
  const Eigen::Matrix3d half_turn = so3_exp(-0.5 * dt_s * earth_rate_E()).toRotationMatrix();
  const Eigen::Matrix3d R = (one - dt_s * earth) * half_turn * before.R_EU.toRotationMatrix();
  v_theta = -R * skew(in.dv_U + 0.5 * in.dtheta_U.cross(in.dv_U));
  v_za = R * (one + 0.5 * turn);
  v_zg = -0.5 * R * push;
  v_v = one - 2.0 * dt_s * earth + (2.0 * dt_s * dt_s) * earth * earth + (0.5 * dt_s * dt_s) * gravity_gradient;
  v_p = dt_s * gravity_gradient;
}

Increments Calibration::apply(double dt_s, const Eigen::Vector3d& dtheta_raw, const Eigen::Vector3d& dv_raw) const {
  Increments out{.dt_s = dt_s, .dtheta_U = dtheta_raw - dt_s * gyro_bias, .dv_U = dv_raw - dt_s * accel_bias};
  if (!gyro_gain.isZero(0.0)) out.dtheta_U = (Eigen::Matrix3d::Identity() + gyro_gain).inverse() * out.dtheta_U;
  if (!accel_gain.isZero(0.0)) out.dv_U = (Eigen::Matrix3d::Identity() + accel_gain).inverse() * out.dv_U;
  return out;
}

void propagate_covariance(ErrorMatrix& P, const StepJacobian& step, const Increments& in,
                          const Calibration& calibration, const ImuNoise& noise, const BiasModel& gyro_bias,
                          const BiasModel& accel_bias, bool with_gains) {
  add_half_white(P, noise, step.dt_s);
  if (with_gains) {
    propagate<Index::kAll - kMoving>(P, step, in, calibration);
  } else {
    propagate<6>(P, step, in, calibration);
  }
  add_half_white(P, noise, step.dt_s);
  decay_bias(P, Index::kGyroBias, gyro_bias, step.dt_s);
  decay_bias(P, Index::kAccelBias, accel_bias, step.dt_s);
}

}  // namespace canyon::fusion
