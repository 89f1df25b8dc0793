#include "canyon/fusion/error_propagation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/antenna_position.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using AllVector = Eigen::Matrix<double, Index::kAll, 1>;

NavState some_state() {
  const LocalFrame frame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
  NavState s;
  s.t = GpsTime::from_week_sow(1590, 0.0);
  s.R_EU = Eigen::Quaterniond(frame.R_EW()) * rotation_from({.yaw_rad = 1.0, .pitch_rad = 0.2, .roll_rad = -0.4});
  s.p_EU_E = frame.to_E({120.0, -45.0, 3.0});
  s.v_EU_E = frame.R_EW() * Eigen::Vector3d(8.0, -5.0, 0.3);
  return s;
}

/// Truth whose error (truth minus estimate) against `s` is `e`.
NavState perturbed(const NavState& s, const Vector9d& e) {
  NavState out = s;
  out.R_EU = (s.R_EU * so3_exp(e.head<3>())).normalized();
  out.p_EU_E += e.segment<3>(3);
  out.v_EU_E += e.tail<3>();
  return out;
}

Vector9d error_of(const NavState& truth, const NavState& estimate) {
  Vector9d e;
  e << so3_log(estimate.R_EU.conjugate() * truth.R_EU), truth.p_EU_E - estimate.p_EU_E, truth.v_EU_E - estimate.v_EU_E;
  return e;
}

/// 100 Hz of a hard drive: 57 deg/s and 1.2 g.
constexpr double kDt = 0.01;
const Eigen::Vector3d kDtheta(0.004, -0.003, 0.0087);
const Eigen::Vector3d kDv(0.03, -0.05, 0.1);

Calibration some_calibration() {
  Calibration c;
  c.gyro_bias = {1e-3, -2e-3, 3e-3};
  c.accel_bias = {0.02, 0.01, -0.03};
  Eigen::Matrix3d g, a;
  g << 1, -2, 3, 4, -5, 6, -7, 8, 9;
  a << -2, 3, 1, 5, 4, -6, 9, -8, 7;
  c.set_gains(1e-3 * g, 1e-3 * a);
  return c;
}

/// Moves the calibration to the truth whose errors are the last 24 of `e`.
Calibration perturbed(const Calibration& c, const AllVector& e) {
  Calibration out = c;
  out.gyro_bias += e.segment<3>(Index::kGyroBias);
  out.accel_bias += e.segment<3>(Index::kAccelBias);
  Eigen::Matrix3d g = c.gyro_gain, a = c.accel_gain;
  for (int i = 0; i < 9; ++i) {
    g(i / 3, i % 3) += e[Index::kGyroGain + i];
    a(i / 3, i % 3) += e[Index::kAccelGain + i];
  }
  out.set_gains(g, a);
  return out;
}

/// One step of the real filter equations, calibration included, as a function of all errors.
NavState step_with_error(const AllVector& e) {
  NavState s = perturbed(some_state(), e.head<9>());
  auto strapdown = make_strapdown("two_sample");
  strapdown->advance(s, perturbed(some_calibration(), e).apply(kDt, kDtheta, kDv));
  return s;
}

/// The 9 x 33 transition the filter uses, read off propagate_covariance by feeding it one column at a time.
Eigen::Matrix<double, 9, Index::kAll> transition() {
  const NavState before = some_state();
  const Calibration c = some_calibration();
  const Increments in = c.apply(kDt, kDtheta, kDv);
  const StepJacobian step(before, in, gravity_gradient_E(before.p_EU_E));
  ErrorProcesses quiet(ImuNoise{}, true, 0.0);
  Eigen::Matrix<double, 9, Index::kAll> phi;
  for (int j = 0; j < Index::kAll; ++j) {
    // With P = e_j e_r' + e_r e_j' and a constant parameter r, cov(x+, r) = Phi P e_r = Phi e_j.
    const int r = j == Index::kAccelGain + 8 ? Index::kAccelGain + 7 : Index::kAccelGain + 8;
    ErrorMatrix P = ErrorMatrix::Zero();
    P(j, r) = P(r, j) = 1.0;
    propagate_covariance(P, step, in, c, quiet);
    phi.col(j) = P.block<9, 1>(0, r);
  }
  return phi;
}

TEST(ErrorPropagation, TransitionIsTheDerivativeOfTheStep) {
  const Eigen::Matrix<double, 9, Index::kAll> phi = transition();
  const NavState nominal = step_with_error(AllVector::Zero());
  // Left out are terms of third order in an interval's rotation and push (dtheta x (dtheta x dv) / 6 and its kin).
  const double turn = kDtheta.norm(), push = kDv.norm();
  for (int j = 0; j < Index::kAll; ++j) {
    // Steps large against rounding (positions are 6e6 m: 1e-9 m), small against curvature.
    const double step = j < 3 ? 1e-4 : j < 6 ? 100.0 : j < 9 ? 1.0 : j < Index::kGyroGain ? 1e-1 : 1e-3;
    AllVector e = AllVector::Zero();
    e[j] = step;
    const Vector9d numeric =
        (error_of(step_with_error(e), nominal) - error_of(step_with_error(-e), nominal)) / (2.0 * step);
    const double scale = j < Index::kGyroBias ? 1.0 : j < Index::kGyroGain ? kDt : std::max(turn, push);
    const double attitude = scale * turn * turn + 1e-9;
    const double velocity = scale * turn * std::max(turn, push) + 1e-9;
    const Vector9d difference = (numeric - phi.col(j)).cwiseAbs();
    EXPECT_LT(difference.head<3>().maxCoeff(), attitude) << "column " << j;
    EXPECT_LT(difference.tail<3>().maxCoeff(), velocity) << "column " << j;
    EXPECT_LT(difference.segment<3>(3).maxCoeff(), kDt * velocity + 1e-9 / step + 1e-9) << "column " << j;
  }
}

/// An independent dense form: P+ = Phi (P + Q/2) Phi' + Q/2 with the full 33 x 33 matrices.
TEST(ErrorPropagation, SparseFormIsTheDenseOne) {
  ImuNoise noise;
  noise.gyro = {.white_per_sqrt_hz = 1e-4,
                .turn_on_bias_sigma = 1e-3,
                .in_run_bias_sigma = 1e-4,
                .in_run_bias_tau_s = 10.0,
                .scale_sigma = 1e-3,
                .misalignment_sigma_rad = 2e-3};
  noise.accel = {.white_per_sqrt_hz = 1e-3,
                 .turn_on_bias_sigma = 0.0,
                 .in_run_bias_sigma = 0.02,
                 .in_run_bias_tau_s = 100.0,
                 .scale_sigma = 1e-3,
                 .misalignment_sigma_rad = 2e-3};
  const ErrorProcesses processes(noise, true, 50.0);

  ErrorMatrix phi = ErrorMatrix::Identity();
  phi.topRows<9>() = transition();
  Eigen::Matrix<double, Index::kAll, 1> half_white = AllVector::Zero(), driven = AllVector::Zero();
  half_white.segment<3>(Index::kTheta).setConstant(0.5 * kDt * 1e-8);
  half_white.segment<3>(Index::kVelocity).setConstant(0.5 * kDt * 1e-6);
  const auto decays = [&](int first, int count, double decay, double stationary) {
    for (int i = first; i < first + count; ++i) {
      phi(i, i) = decay;
      driven[i] = stationary * (1.0 - decay * decay);
    }
  };
  decays(Index::kGyroBias, 3, processes.gyro_bias.decay(kDt), std::pow(processes.gyro_bias.sigma, 2));
  decays(Index::kAccelBias, 3, std::exp(-kDt / 100.0), 4e-4);
  for (int i = 0; i < 9; ++i) {
    decays(Index::kGyroGain + i, 1, std::exp(-kDt / 50.0), i % 4 == 0 ? 1e-6 : 4e-6);
    decays(Index::kAccelGain + i, 1, std::exp(-kDt / 50.0), i % 4 == 0 ? 1e-6 : 4e-6);
  }

  const RandomStream stream(1, "test.covariance");
  ErrorMatrix A;
  for (int i = 0; i < Index::kAll; ++i) {
    for (int j = 0; j < Index::kAll; ++j)
      A(i, j) = stream.normal(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(j));
  }
  ErrorMatrix P = A * A.transpose();
  P = 0.5 * (P + P.transpose()).eval();
  ErrorMatrix dense = phi * (P + ErrorMatrix(half_white.asDiagonal())) * phi.transpose();
  dense += ErrorMatrix((half_white + driven).asDiagonal());

  const NavState before = some_state();
  const Increments in = some_calibration().apply(kDt, kDtheta, kDv);
  propagate_covariance(P, StepJacobian(before, in, gravity_gradient_E(before.p_EU_E)), in, some_calibration(),
                       processes);
  const double scale = dense.cwiseAbs().maxCoeff();
  EXPECT_LT((P - dense).cwiseAbs().maxCoeff(), 100.0 * std::numeric_limits<double>::epsilon() * scale);
  EXPECT_EQ(P, P.transpose().eval());
}

TEST(ErrorPropagation, FifteenStatesAreTheSameWithoutGains) {
  ImuNoise noise;
  noise.gyro.white_per_sqrt_hz = 1e-4;
  noise.gyro.turn_on_bias_sigma = 1e-3;
  noise.accel.white_per_sqrt_hz = 1e-3;
  noise.accel.turn_on_bias_sigma = 1e-2;
  const NavState before = some_state();
  const Increments in{.dt_s = kDt, .dtheta_U = kDtheta, .dv_U = kDv};
  const StepJacobian step(before, in, gravity_gradient_E(before.p_EU_E));
  ErrorMatrix with = ErrorMatrix::Zero();
  with.topLeftCorner<15, 15>().setIdentity();
  ErrorMatrix without = with;
  propagate_covariance(with, step, in, {}, ErrorProcesses(noise, true, 0.0));
  propagate_covariance(without, step, in, {}, ErrorProcesses(noise, false, 0.0));
  EXPECT_LT((with - without).cwiseAbs().maxCoeff(), 64.0 * std::numeric_limits<double>::epsilon());
}

TEST(BiasModel, CarriesTurnOnAndInRunInOneState) {
  TriadNoise n;
  n.turn_on_bias_sigma = 3.0;
  n.in_run_bias_sigma = 0.1;
  n.in_run_bias_tau_s = 100.0;
  const BiasModel both(n);
  EXPECT_NEAR(both.sigma * both.sigma, 9.01, 1e-14);
  // Driven at the in-run rate: variance 2 * 0.01 / 100 per second.
  EXPECT_NEAR(both.added_variance(0.01) / 0.01, 2e-4, 1e-9);
  // The turn-on bias outlives the in-run correlation time: after ten of them 98.9 % are left, not 5e-5.
  EXPECT_NEAR(both.decay(1000.0), std::exp(-1000.0 / 90100.0), 1e-15);
  // Stationary: what decays is what is added.
  const double p = both.sigma * both.sigma;
  EXPECT_NEAR(p * std::pow(both.decay(7.0), 2) + both.added_variance(7.0), p, 1e-14);

  n.turn_on_bias_sigma = 0.0;
  EXPECT_EQ(BiasModel(n).tau_s, 100.0);  // then it is the Gauss-Markov process itself
  n = {};
  n.turn_on_bias_sigma = 2.0;
  EXPECT_EQ(BiasModel(n).decay(1e6), 1.0);  // and a random constant
  EXPECT_EQ(BiasModel(n).added_variance(1e6), 0.0);
}

TEST(AntennaPosition, JacobianIsTheDerivative) {
  const NavState s = some_state();
  const Eigen::Vector3d rate(0.1, -0.2, 0.4), arm(-0.5, 0.1, 0.8);
  const double age_s = 0.03;
  const AntennaPosition nominal = antenna_position(s, rate, arm, age_s);
  for (int j = 0; j < 9; ++j) {
    const double step = j < 3 ? 1e-3 : 10.0;
    Vector9d e = Vector9d::Zero();
    e[j] = step;
    const Eigen::Vector3d numeric = (antenna_position(perturbed(s, e), rate, arm, age_s).p_A_E -
                                     antenna_position(perturbed(s, -e), rate, arm, age_s).p_A_E) /
                                    (2.0 * step);
    // Curvature step^2 / 6 of a metre, and rounding of 6e6 m.
    EXPECT_LT((numeric - nominal.H.col(j)).norm(), step < 1.0 ? 1e-6 + 2e-9 / step : 1e-9) << j;
  }
  const AntennaPosition here = antenna_position(s, rate, arm, 0.0);
  EXPECT_LT((here.p_A_E - (s.p_EU_E + s.R_EU * arm)).norm(), 2e-9);
}

TEST(Reset, JacobianIsTheDerivative) {
  // After injecting d the error e becomes Log(Exp(d)^-1 Exp(e)); its derivative at e = d is Jr(d).
  const Eigen::Vector3d d(0.2, -0.1, 0.3);
  const Eigen::Matrix3d reset = so3_right_jacobian(d);
  const double h = 1e-5;
  for (int j = 0; j < 3; ++j) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(j);
    const auto after = [&](const Eigen::Vector3d& e) { return so3_log(so3_exp(d).conjugate() * so3_exp(e)); };
    const Eigen::Vector3d numeric = (after(d + step) - after(d - step)) / (2.0 * h);
    EXPECT_LT((numeric - reset.col(j)).norm(), h * h + 1e-15 / h) << j;
  }
}

}  // namespace
}  // namespace canyon::fusion
