#include "canyon/fusion/error_propagation.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
template <int Rows, int Columns>
using RowMatrix = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;
using Row3 = RowMatrix<3, 3>;

constexpr int kMoving = 9;  // theta, p, v

/// sum_j m(i, j) rows.row(j), one pass over the columns.
template <class Rows>
auto combine(const Eigen::Matrix3d& m, int i, const Rows& rows) {
  return m(i, 0) * rows.row(0) + m(i, 1) * rows.row(1) + m(i, 2) * rows.row(2);
}

/// Rows of x after the step, from rows of x before it and rows of z, for any number of columns at once.
template <int Columns, class X>
RowMatrix<kMoving, Columns> apply(const StepJacobian& s, const X& x, const RowMatrix<6, Columns>& z) {
  const auto theta = x.template topRows<3>();
  const auto p = x.template middleRows<3>(3);
  const auto v = x.template bottomRows<3>();
  const auto zg = z.template topRows<3>();
  const auto za = z.template bottomRows<3>();
  RowMatrix<kMoving, Columns> next;
  for (int i = 0; i < 3; ++i) {
    next.row(i) = combine(s.theta_theta, i, theta) + combine(s.theta_zg, i, zg);
    next.row(6 + i) = combine(s.v_theta, i, theta) + combine(s.v_p, i, p) + combine(s.v_v, i, v) +
                      combine(s.v_zg, i, zg) + combine(s.v_za, i, za);
    next.row(3 + i) = p.row(i) + (0.5 * s.dt_s) * (v.row(i) + next.row(6 + i));
  }
  return next;
}

/// Rows z = E y for rows y of the parameters [b_g, b_a, K_g, K_a] (or only the biases): the error of an increment is
/// -(I + K_hat)^-1 (b dt + K increment).
template <int Parameters, int Columns, class Y>
RowMatrix<6, Columns> increment_errors(const Y& y, const Increments& in, const Calibration& c) {
  RowMatrix<6, Columns> raw;
  for (int i = 0; i < 3; ++i) {
    if constexpr (Parameters > 6) {
      const int g = 6 + 3 * i, a = 15 + 3 * i;
      raw.row(i) = in.dt_s * y.row(i) + in.dtheta_U.x() * y.row(g) + in.dtheta_U.y() * y.row(g + 1) +
                   in.dtheta_U.z() * y.row(g + 2);
      raw.row(3 + i) =
          in.dt_s * y.row(3 + i) + in.dv_U.x() * y.row(a) + in.dv_U.y() * y.row(a + 1) + in.dv_U.z() * y.row(a + 2);
    } else {
      raw.row(i) = in.dt_s * y.row(i);
      raw.row(3 + i) = in.dt_s * y.row(3 + i);
    }
  }
  RowMatrix<6, Columns> z;
  for (int i = 0; i < 3; ++i) {
    z.row(i) = -combine(c.gyro_inverse, i, raw.template topRows<3>());
    z.row(3 + i) = -combine(c.accel_inverse, i, raw.template bottomRows<3>());
  }
  return z;
}

template <int Parameters>
void propagate(ErrorMatrix& P, const StepJacobian& step, const Increments& in, const Calibration& c) {
  constexpr int kWidth = kMoving + Parameters;
  // cov(x+, [x, y]) from cov([x, z], [x, y]), z being the part of the increments' error that the parameters y make.
  const auto P_x = P.template topLeftCorner<kMoving, kWidth>();
  const auto P_y = P.template block<Parameters, kWidth>(kMoving, 0);
  const RowMatrix<6, kWidth> P_z = increment_errors<Parameters, kWidth>(P_y, in, c);
  const RowMatrix<kMoving, kWidth> half = apply<kWidth>(step, P_x, P_z);

  // Then cov(x+, x+) from cov([x, z], x+).
  const RowMatrix<kMoving, kMoving> x_half = half.template leftCols<kMoving>().transpose();
  const RowMatrix<Parameters, kMoving> y_half = half.template rightCols<Parameters>().transpose();
  const RowMatrix<6, kMoving> z_half = increment_errors<Parameters, kMoving>(y_half, in, c);
  const RowMatrix<kMoving, kMoving> P_xx = apply<kMoving>(step, x_half, z_half);

  P.template topLeftCorner<kMoving, kMoving>() = 0.5 * (P_xx + P_xx.transpose());
  P.template block<kMoving, Parameters>(0, kMoving) = half.template rightCols<Parameters>();
  P.template block<Parameters, kMoving>(kMoving, 0) = y_half;
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

void decay_gains(ErrorMatrix& P, const ErrorProcesses& processes, double dt_s) {
  const double decay = std::exp(-dt_s / processes.gain_tau_s);
  const double share = -std::expm1(-2.0 * dt_s / processes.gain_tau_s);
  P.bottomRows<Index::kAll - Index::kNavigation>() *= decay;
  P.rightCols<Index::kAll - Index::kNavigation>() *= decay;
  for (int i = 0; i < 9; ++i) {
    P(Index::kGyroGain + i, Index::kGyroGain + i) += share * gain_variance(processes.noise.gyro, i);
    P(Index::kAccelGain + i, Index::kAccelGain + i) += share * gain_variance(processes.noise.accel, i);
  }
}

}  // namespace

double gain_variance(const TriadNoise& noise, int element) {
  const double sigma = element % 4 == 0 ? noise.scale_sigma : noise.misalignment_sigma_rad;
  return sigma * sigma;
}

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
  return {.dt_s = dt_s,
          .dtheta_U = gyro_inverse * (dtheta_raw - dt_s * gyro_bias),
          .dv_U = accel_inverse * (dv_raw - dt_s * accel_bias)};
}

void Calibration::set_gains(const Eigen::Matrix3d& gyro, const Eigen::Matrix3d& accel) {
  gyro_gain = gyro;
  accel_gain = accel;
  gyro_inverse = (Eigen::Matrix3d::Identity() + gyro).inverse();
  accel_inverse = (Eigen::Matrix3d::Identity() + accel).inverse();
}

ErrorProcesses::ErrorProcesses(const ImuNoise& imu, bool gains, double tau_s)
    : noise(imu), gyro_bias(imu.gyro), accel_bias(imu.accel), with_gains(gains), gain_tau_s(tau_s) {}

void propagate_covariance(ErrorMatrix& P, const StepJacobian& step, const Increments& in,
                          const Calibration& calibration, const ErrorProcesses& processes) {
  add_half_white(P, processes.noise, step.dt_s);
  if (processes.with_gains) {
    propagate<Index::kAll - kMoving>(P, step, in, calibration);
  } else {
    propagate<6>(P, step, in, calibration);
  }
  add_half_white(P, processes.noise, step.dt_s);
  decay_bias(P, Index::kGyroBias, processes.gyro_bias, step.dt_s);
  decay_bias(P, Index::kAccelBias, processes.accel_bias, step.dt_s);
  if (processes.with_gains && processes.gain_tau_s > 0.0) decay_gains(P, processes, step.dt_s);
}

void propagate_errors(ErrorMatrix& errors, const StepJacobian& step, const Increments& in,
                      const Calibration& calibration, const ErrorProcesses& processes) {
  constexpr int kGains = Index::kAll - kMoving;
  const RowMatrix<6, Index::kAll> increments =
      processes.with_gains ? increment_errors<kGains, Index::kAll>(errors.bottomRows<kGains>(), in, calibration)
                           : increment_errors<6, Index::kAll>(errors.middleRows<6>(kMoving), in, calibration);
  errors.topRows<kMoving>() = apply<Index::kAll>(step, errors.topRows<kMoving>(), increments).eval();
  errors.middleRows<3>(Index::kGyroBias) *= processes.gyro_bias.decay(step.dt_s);
  errors.middleRows<3>(Index::kAccelBias) *= processes.accel_bias.decay(step.dt_s);
  if (processes.with_gains && processes.gain_tau_s > 0.0)
    errors.bottomRows<Index::kAll - Index::kNavigation>() *= std::exp(-step.dt_s / processes.gain_tau_s);
}

}  // namespace canyon::fusion
