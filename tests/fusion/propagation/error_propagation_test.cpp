#include "canyon/fusion/propagation/error_propagation.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/propagation/van_loan.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Eigen::VectorXd;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kGyroBias = 9, kGains = 15, kAll = 33;

NavState some_state() {
  const LocalFrame frame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
  NavState s;
  s.t = GpsTime::from_week_sow(1590, 0.0);
  s.R_EU = Eigen::Quaterniond(frame.R_EW()) * rotation_from({.yaw_rad = 1.0, .pitch_rad = 0.2, .roll_rad = -0.4});
  s.p_EU_E = frame.to_E({120.0, -45.0, 3.0});
  s.v_EU_E = frame.R_EW() * Eigen::Vector3d(8.0, -5.0, 0.3);
  return s;
}

Vector9d error_vector(const NavState& truth, const NavState& estimate) {
  Vector9d e;
  e << so3_log(estimate.R_EU.conjugate() * truth.R_EU), truth.p_EU_E - estimate.p_EU_E, truth.v_EU_E - estimate.v_EU_E;
  return e;
}

/// 100 Hz of a hard drive: 57 deg/s and 1.2 g.
constexpr double kDt = 0.01;
const Eigen::Vector3d kDtheta(0.004, -0.003, 0.0087);
const Eigen::Vector3d kDv(0.03, -0.05, 0.1);

/// Every state block, constant or wandering as `tau_s` says, none without uncertainty.
ImuNoise some_noise(double tau_s = kInfinite) {
  ImuNoise noise;
  noise.gyro = {.white_per_sqrt_hz = 1e-4,
                .turn_on_bias_sigma = 1e-3,
                .in_run_bias_sigma = tau_s == kInfinite ? 0.0 : 1e-4,
                .in_run_bias_tau_s = tau_s,
                .scale_sigma = 1e-3,
                .misalignment_sigma_rad = 2e-3};
  noise.accel = {.white_per_sqrt_hz = 1e-3,
                 .turn_on_bias_sigma = 0.01,
                 .in_run_bias_sigma = tau_s == kInfinite ? 0.0 : 0.02,
                 .in_run_bias_tau_s = 3.0 * tau_s,
                 .scale_sigma = 1e-3,
                 .misalignment_sigma_rad = 2e-3};
  return noise;
}

FilterConfig with_gains_of(double tau_s) {
  return configured("imu_gain_tau_s = " + number_text(tau_s));
}

/// The state of a filter with biases and gains, of some size each.
ErrorState some_estimate(const ImuNoise& noise = some_noise(), double gain_tau_s = 0.0) {
  ErrorState state({"biases", "gains"}, with_gains_of(gain_tau_s).own, {.noise = noise});
  state.start(some_state());
  VectorXd values = VectorXd::Zero(state.padded_size());
  values.segment<6>(kGyroBias) << 1e-3, -2e-3, 3e-3, 0.02, 0.01, -0.03;
  values.segment<18>(kGains) << 1, -2, 3, 4, -5, 6, -7, 8, 9, -2, 3, 1, 5, 4, -6, 9, -8, 7;
  values.segment<18>(kGains) *= 1e-3;
  state.inject(values);
  return state;
}

/// One step of the real filter equations, calibration included, as a function of all errors.
NavState step_with_error(const VectorXd& e) {
  ErrorState state = some_estimate();
  state.inject(e);
  auto strapdown = make_strapdown("two_sample");
  strapdown->advance(state.nav, state.calibration().apply(kDt, kDtheta, kDv));
  return state.nav;
}

/// Errors and covariances over that step, linearized.
ErrorPropagation some_step(ErrorState& state, const ImuNoise& noise, double dt_s = kDt,
                           const Eigen::Vector3d& dtheta = kDtheta, const Eigen::Vector3d& dv = kDv) {
  ErrorPropagation step(state, noise);
  step.set_interval(dt_s);
  const Calibration known = state.step_calibration(step.mean_share());
  step.set_step(state, known.apply(dt_s, dtheta, dv), known, gravity_gradient_E(state.nav.p_EU_E));
  return step;
}

ErrorMatrix some_covariance(int size, int padded) {
  const RandomStream stream(1, "test.covariance");
  ErrorMatrix A = ErrorMatrix::Zero(padded, padded);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j)
      A(i, j) = stream.normal(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(j));
  }
  ErrorMatrix P = A * A.transpose();
  return 0.5 * (P + P.transpose());
}

TEST(ErrorPropagation, TransitionIsTheDerivativeOfTheStep) {
  ErrorState state = some_estimate();
  ErrorMatrix phi = ErrorMatrix::Identity(state.padded_size(), state.padded_size());
  some_step(state, some_noise()).move(phi);
  const NavState nominal = step_with_error(VectorXd::Zero(state.padded_size()));
  // Left out are terms of third order in an interval's rotation and push (dtheta x (dtheta x dv) / 6 and its kin).
  const double turn = kDtheta.norm(), push = kDv.norm();
  for (int j = 0; j < kAll; ++j) {
    // Steps large against rounding (positions are 6e6 m: 1e-9 m), small against curvature.
    const double step = j < 3 ? 1e-4 : j < 6 ? 100.0 : j < 9 ? 1.0 : j < kGains ? 1e-1 : 1e-3;
    VectorXd e = VectorXd::Zero(state.padded_size());
    e[j] = step;
    const Vector9d numeric =
        (error_vector(step_with_error(e), nominal) - error_vector(step_with_error(-e), nominal)) / (2.0 * step);
    const double scale = j < kGyroBias ? 1.0 : j < kGains ? kDt : std::max(turn, push);
    const double attitude = scale * turn * turn + 1e-9;
    const double velocity = scale * turn * std::max(turn, push) + 1e-9;
    const Vector9d difference = (numeric - phi.col(j).head<9>()).cwiseAbs();
    EXPECT_LT(difference.head<3>().maxCoeff(), attitude) << "column " << j;
    EXPECT_LT(difference.tail<3>().maxCoeff(), velocity) << "column " << j;
    // The integrator takes position as the trapezoid of velocity: of a turning force dt^3 / 4 where the integral has
    // dt^3 / 6, which the errors have.
    const double trapezoid = j < kGyroBias ? 0.0 : kDt * push * scale / 12.0;
    EXPECT_LT(difference.segment<3>(3).maxCoeff(), kDt * velocity + trapezoid + 1e-9 / step + 1e-9) << "column " << j;
  }
}

/// What the rows do to a covariance is Phi P Phi' with the full matrices; noise is added to it.
TEST(ErrorPropagation, SparseFormIsTheDenseOne) {
  for (const double tau_s : {0.02, 10.0, kInfinite}) {
    const ImuNoise noise = some_noise(tau_s);
    ErrorState state = some_estimate(noise, 50.0);
    ErrorPropagation step = some_step(state, noise);
    const int n = state.padded_size();
    ErrorMatrix phi = ErrorMatrix::Identity(n, n);
    step.move(phi);
    ErrorMatrix added = ErrorMatrix::Zero(n, n);
    step.propagate(added);
    ErrorMatrix P = some_covariance(kAll, n);
    const ErrorMatrix dense = phi * P * phi.transpose() + added;
    step.propagate(P);
    const double scale = dense.cwiseAbs().maxCoeff();
    EXPECT_LT((P - dense).cwiseAbs().maxCoeff(), 100.0 * std::numeric_limits<double>::epsilon() * scale) << tau_s;
    EXPECT_EQ(P, P.transpose().eval());
    EXPECT_TRUE((P.bottomRows(n - kAll).array() == 0.0).all());
  }
}

/// The continuous model without rotation: theta' = -G e_g, v' = -R [f]x theta - R A e_a, p' = v, each bias -b / tau + w
/// and each gain -k / tau + w, where G and A take the estimated gains out of the output.
VanLoan continuous(const ErrorState& state, const ImuNoise& noise, double dt_s, const Eigen::Vector3d& f) {
  LongMatrix F = LongMatrix::Zero(kAll, kAll), Q = LongMatrix::Zero(kAll, kAll);
  const Calibration imu = state.calibration();
  const Eigen::Matrix3d R = state.nav.R_EU.toRotationMatrix();
  const Eigen::Vector3d earth_U = R.transpose() * earth_rate_E();
  const auto longer = [](const Eigen::Matrix3d& m) -> LongMatrix { return m.cast<long double>(); };
  F.block(0, 9, 3, 3) = longer(-imu.gyro_inverse);
  F.block(3, 6, 3, 3).setIdentity();
  F.block(6, 0, 3, 3) = longer(-R * skew(f));
  F.block(6, 12, 3, 3) = longer(-R * imu.accel_inverse);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      F.block(0, 15 + 3 * i + j, 3, 1) = longer(-imu.gyro_inverse).col(i) * earth_U[j];
      F.block(6, 24 + 3 * i + j, 3, 1) = longer(-R * imu.accel_inverse).col(i) * f[j];
    }
  }
  const double white_g = std::pow(noise.gyro.white_per_sqrt_hz, 2),
               white_a = std::pow(noise.accel.white_per_sqrt_hz, 2);
  Q.topLeftCorner(3, 3) = longer(white_g * imu.gyro_inverse * imu.gyro_inverse.transpose());
  Q.block(6, 6, 3, 3) = longer(white_a * imu.accel_inverse * imu.accel_inverse.transpose());
  for (const ErrorState::Member& member : state.members()) {
    for (int i = 0; i < member.block->size(); ++i) {
      const StateProcess process = member.block->process(i);
      F(member.offset + i, member.offset + i) = -1.0L / static_cast<long double>(process.tau_s);
      Q(member.offset + i, member.offset + i) = process.density;
    }
  }
  return {F, Q, dt_s};
}

// 2026-11-23: noise and biases entered as if constant within a step, which of a process faster than the step says
// nothing: with a correlation time of a tenth of the step, 2.4 times too much velocity.
TEST(ErrorPropagation, IsVanLoansForEveryCorrelationTime) {
  const Eigen::Vector3d f(0.3, -0.5, 9.8);
  for (const double dt_s : {0.001, 0.01, 1.0}) {
    for (const double ratio : {1e-6, 0.01, 0.5, 10.0, 1e4}) {
      const double tau_s = dt_s / ratio;
      const ImuNoise noise = some_noise(tau_s);
      ErrorState state({"biases", "gains"}, with_gains_of(tau_s).own, {.noise = noise});
      state.start(some_state());
      // In E, which turns: the unit turns with it.
      const Eigen::Vector3d turn = dt_s * (state.nav.R_EU.conjugate() * earth_rate_E());
      ErrorPropagation step = some_step(state, noise, dt_s, turn, dt_s * f);
      const VanLoan expected = continuous(state, noise, dt_s, f);
      const int n = state.padded_size();
      ErrorMatrix added = ErrorMatrix::Zero(n, n), phi = ErrorMatrix::Identity(n, n);
      step.propagate(added);
      step.move(phi);
      // What the continuous model leaves out: Earth rate and the gravity gradient.
      const double left_out = 20.0 * (7.3e-5 * dt_s + 3e-6 * dt_s * dt_s) + 1e-12;
      for (int i = 0; i < kAll; ++i) {
        for (int j = 0; j < kAll; ++j) {
          const double scale = std::sqrt(added(i, i) * added(j, j));
          EXPECT_NEAR(added(i, j), static_cast<double>(expected.noise(i, j)), left_out * scale + 1e-300)
              << dt_s << ' ' << ratio << ' ' << i << ' ' << j;
          const double size = i < 9 && j >= 9 ? std::abs(static_cast<double>(expected.transition(i, j))) : 1.0;
          EXPECT_NEAR(phi(i, j), static_cast<double>(expected.transition(i, j)), left_out * (size + dt_s))
              << dt_s << ' ' << ratio << ' ' << i << ' ' << j;
        }
      }
    }
  }
}

TEST(ErrorPropagation, FifteenStatesAreTheSameWithoutGains) {
  ImuNoise noise;
  noise.gyro.white_per_sqrt_hz = 1e-4;
  noise.gyro.turn_on_bias_sigma = 1e-3;
  noise.accel.white_per_sqrt_hz = 1e-3;
  noise.accel.turn_on_bias_sigma = 1e-2;
  ImuNoise with_gains = noise;
  with_gains.gyro.scale_sigma = 1e-3;
  const auto after = [](const ImuNoise& n) {
    ErrorState state({"biases", "gains"}, FilterConfig().own, {.noise = n});
    state.start(some_state());
    ErrorMatrix P = ErrorMatrix::Zero(state.padded_size(), state.padded_size());
    P.topLeftCorner<15, 15>().setIdentity();
    some_step(state, n).propagate(P);
    return P.topLeftCorner<15, 15>().eval();
  };
  EXPECT_LT((after(noise) - after(with_gains)).cwiseAbs().maxCoeff(), 64.0 * std::numeric_limits<double>::epsilon());
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
