#include <vector>

#include <Eigen/Eigenvalues>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using stress::kEpsilon;
using Matrix = Eigen::MatrixXd;

/// Broken unless symmetric to the bit, with variances above zero, and with no eigenvalue of the correlations below
/// what rounding of n of them makes (they are sums of n terms of size 1, each rounded in the update and in the solver).
bool is_broken(const Matrix& P) {
  if (!P.allFinite() || P != P.transpose() || !(P.diagonal().head<15>().array() > 0.0).all()) return true;
  // What is known for certain, as a gain error that the unit does not have, is correlated with nothing.
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(P.rows());
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    if (P(i, i) > 0.0) scale[i] = 1.0 / std::sqrt(P(i, i));
    if (P(i, i) < 0.0 || (P(i, i) == 0.0 && !P.row(i).isZero(0.0))) return true;
  }
  const auto n = static_cast<double>(P.rows());
  const Matrix correlation = scale.asDiagonal() * P * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(correlation, Eigen::EigenvaluesOnly);
  return !(eigen.eigenvalues().minCoeff<Eigen::PropagateNaN>() > -2.0 * n * n * kEpsilon);
}

/// Predictions at 100 Hz with a fix every ten, from a position unknown by `ratio` times the fix's own sigma.
StressFigure noise_ratio(double ratio, std::int64_t steps) {
  FilterConfig config;
  config.initial_position_sigma_m = std::min(1e5, ratio);
  config.initial_velocity_sigma_m_s = 100.0;
  RestingFilter rest(config, usual_noise(), 100.0);
  const double sigma_m = config.initial_position_sigma_m / ratio;
  int broken = is_broken(rest.filter.covariance()) ? 1 : 0;
  for (std::int64_t k = 1; k <= steps; ++k) {
    rest.predict();
    const bool look = k < 200 || k % 997 == 0;
    if (look) broken += is_broken(rest.filter.covariance()) ? 1 : 0;
    if (k % 10 != 0) continue;
    rest.filter.update(rest.fix(sigma_m));
    if (look || k % 1000 == 0) broken += is_broken(rest.filter.covariance()) ? 1 : 0;
  }
  return {1.0 * broken, 0.0};
}

/// Smallest eigenvalue of P in units of the variances of `before`, by 2 n^2 epsilons of them: rounding of sums of n x n
/// terms of that size. Infinite where P is not symmetric to the bit.
double below_nothing(const Matrix& P, const Matrix& before) {
  if (!P.allFinite() || P != P.transpose()) return stress::kInfinity;
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(P.rows());
  for (Eigen::Index i = 0; i < P.rows(); ++i)
    if (before(i, i) > 0.0) scale[i] = 1.0 / std::sqrt(before(i, i));
  const Matrix relative = scale.asDiagonal() * P * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(relative, Eigen::EigenvaluesOnly);
  const auto n = static_cast<double>(P.rows());
  return -eigen.eigenvalues().minCoeff<Eigen::PropagateNaN>() / (2.0 * n * n * kEpsilon);
}

/// A pose measured without any noise, R = 0, every ten predictions, and once more at the same instant: what is left of
/// P is singular, nothing and rounding, no more of it below nothing than rounding of what was; ten predictions on it is
/// definite again.
StressFigure perfect_poses(const std::string& estimator, std::int64_t steps) {
  RestingFilter rest(configured("measurements = [\"map_pose\"]\nestimator = \"" + estimator + "\""), usual_noise(),
                     100.0);
  stress::Worst worst;
  for (std::int64_t k = 1; k <= steps; ++k) {
    rest.predict();
    if (k % 10 != 0) continue;
    const bool look = k < 1000 || k % 1000 == 0;
    const Matrix before = look ? rest.filter.covariance() : Matrix();
    if (look) worst.look(is_broken(before) ? stress::kInfinity : 0.0, 1.0);
    for (int again = 0; again < 2; ++again) {
      rest.filter.update(AidingMessage(PoseInMap{rest.filter.nav_state().t, Pose{}, Matrix6d::Zero()}));
      if (look) worst.look(worse(0.0, below_nothing(rest.filter.covariance(), before)), 1.0);
    }
  }
  worst.look(rest.filter.estimate().X_WB.p.norm(),
             1e-6);  // and it is where the pose says, to rounding of Earth's radius
  return worst.figure();
}

/// Biases that live for 0.1 ms and for 1e6 s in one state, gain errors beside them, 10 000 steps: the fast one's
/// variance is its stationary one to an epsilon a step, the slow one's never grows beyond it, and all stays definite.
StressFigure time_constants(double fast_s, double slow_s) {
  ImuNoise noise = usual_noise();
  noise.gyro.turn_on_bias_sigma = noise.accel.turn_on_bias_sigma = 0.0;
  noise.gyro.in_run_bias_tau_s = fast_s;
  noise.accel.in_run_bias_tau_s = slow_s;
  noise.gyro.scale_sigma = noise.accel.scale_sigma = 1e-3;
  const FilterConfig config = configured("imu_gain_tau_s = " + number_text(slow_s));
  RestingFilter rest(config, noise, 100.0);
  constexpr std::int64_t kSteps = 10'000;
  const double fast = noise.gyro.in_run_bias_sigma * noise.gyro.in_run_bias_sigma,
               slow = noise.accel.in_run_bias_sigma * noise.accel.in_run_bias_sigma;
  stress::Worst worst;
  for (std::int64_t k = 1; k <= kSteps; ++k) {
    rest.predict();
    if (k % 100 == 0) rest.filter.update(rest.fix(1.0));
    if (k % 500 != 490) continue;
    const Matrix P = rest.filter.covariance();
    worst.look(is_broken(P) ? stress::kInfinity : 0.0, 1.0);
    const double step = kEpsilon * static_cast<double>(k);
    const int biases = rest.filter.offset("biases");
    const Eigen::Vector3d gyro = P.diagonal().segment<3>(biases), accel = P.diagonal().segment<3>(biases + 3);
    // What a fix told of it 0.9 s ago is gone where that is many times its life.
    if (fast_s < 0.02) worst.look(gyro.minCoeff<Eigen::PropagateNaN>() / fast - 1.0, step);
    worst.look(beyond(gyro.maxCoeff<Eigen::PropagateNaN>() / fast, 1.0), step);
    worst.look(beyond(accel.maxCoeff<Eigen::PropagateNaN>() / slow, 1.0), step);
  }
  return worst.figure();
}

/// White noise of the accelerometer alone, N^2: after T the horizontal variances are N^2 T and N^2 T^3 / 3, however
/// many steps T is; gravity's pull back to the place is (w_s T)^2 of it at most, Coriolis (2 w_e T)^2, and each step
/// rounds.
StressFigure rate(double rate_hz) {
  ImuNoise noise;
  noise.accel.white_per_sqrt_hz = 1e-3;
  FilterConfig config;
  config.initial_attitude_sigma_deg_roll_pitch = config.initial_attitude_sigma_deg_heading = 1e-6;
  config.initial_position_sigma_m = config.initial_velocity_sigma_m_s = 1e-6;
  RestingFilter rest(config, noise, rate_hz);
  const double T = rate_hz > 1e3 ? 4.0 : std::max(10.0, 1.0 / rate_hz), n = std::round(T * rate_hz);
  for (int k = 0; k < static_cast<int>(n); ++k) rest.predict();
  const Eigen::Matrix3d R_WE = rest.frame.R_EW().transpose();
  const Matrix P = rest.filter.covariance();
  const Eigen::Matrix3d p = R_WE * P.block<3, 3>(3, 3) * R_WE.transpose(),
                        v = R_WE * P.block<3, 3>(6, 6) * R_WE.transpose();
  const double drive = 1e-6, swing = 9.81 / 6.4e6 * T * T, turn = std::pow(2.0 * Wgs84::rate_rad_s * T, 2);
  const double start = 1e-12 * (1.0 + T * T) / (drive * T * T * T / 3.0) + 1e-12 / (drive * T);
  stress::Worst worst;
  for (int axis = 0; axis < 2; ++axis) {
    worst.look(p(axis, axis) / (drive * T * T * T / 3.0) - 1.0, swing + turn + start + 10.0 * n * kEpsilon);
    worst.look(v(axis, axis) / (drive * T) - 1.0, swing + turn + start + 10.0 * n * kEpsilon);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> covariance_cases() {
  const StressMechanism ratio{
      StressGroup::kData, "a covariance over many updates at a large ratio of noises",
      "P - K H P cancels to the 16th digit of what was: variances below zero, and an update that goes astray",
      "symmetric to the bit, variances above zero, correlations definite to the rounding of n by n terms, n states",
      "covariances"};
  const StressMechanism perfect{
      StressGroup::kData, "a measurement without noise",
      "R = 0 leaves a singular P, whose rounding is of either sign; its factor is divided by",
      "symmetric to the bit, semidefinite to the rounding of n by n terms of what was; definite once predicted",
      "of the bound"};
  const StressMechanism constants{
      StressGroup::kStiff, "time constants of ten decades in one state",
      "1 - dt / tau is -99 for the fast one, and 1 - e^(-2 dt / tau) cancels for the slow one",
      "each variance stays its stationary one to an epsilon a step", "of the bound"};
  const StressMechanism rates{
      StressGroup::kStiff, "a covariance at rates from 0.01 to 10 000 Hz",
      "noise per sample in place of per root hertz, or an order of the step less",
      "N^2 T and N^2 T^3 / 3, to the rounding of the steps and what gravity and Coriolis do within T", "of the bound"};
  StressRows rows;
  for (const double r : {1.0, 1e6, 1e9})
    rows.of(ratio).add("covariance/noise_ratio_" + stress::text(r) + "_1e4_steps",
                       [r] { return noise_ratio(r, 10'000); });
  rows.of(ratio).add("covariance/noise_ratio_1e12_1e5_steps", [] { return noise_ratio(1e12, 100'000); });
  rows.of(ratio).add("covariance/noise_ratio_1e12_1e7_steps", [] { return noise_ratio(1e12, 10'000'000); });
  rows.long_running();
  for (const char* estimator : {"joseph", "ud", "invariant"})
    rows.of(perfect).add(std::string("covariance/perfect_poses_by_") + estimator,
                         [=] { return perfect_poses(estimator, 5'000); });
  rows.of(perfect).add("covariance/perfect_poses_1e7_steps", [] { return perfect_poses("joseph", 10'000'000); });
  rows.long_running();
  for (const auto& [fast_s, slow_s] : {std::pair{1e-4, 1e6}, {1e-2, 1e4}, {1.0, 100.0}})
    rows.of(constants).add("covariance/biases_of_" + stress::text(fast_s) + "_and_" + stress::text(slow_s) + "_s",
                           [f = fast_s, s = slow_s] { return time_constants(f, s); });
  for (const double rate_hz : {0.01, 1.0, 100.0, 10000.0})
    rows.of(rates).add("covariance/rate_" + stress::text(rate_hz) + "_hz", [=] { return rate(rate_hz); });
  return rows.take();
}

}  // namespace canyon::fusion
