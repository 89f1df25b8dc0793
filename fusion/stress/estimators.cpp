// The forms in which a covariance is kept and moved, against one another and against the closed form of its parts.
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using stress::kEpsilon;
using stress::Worst;
using Matrix = Eigen::MatrixXd;

/// Ten seconds of a drive with a fix each second.
ErrorStateFilter driven(const Drive& drive, const std::string& estimator) {
  FilterConfig config = drive.config;
  config.estimator = estimator;
  ErrorStateFilter filter(config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  auto fix = drive.fixes.begin();
  for (const ImuSample& imu : drive.imu) {
    filter.predict(imu);
    while (fix != drive.fixes.end() && fix->t <= imu.t) filter.update(*fix++);
  }
  return filter;
}

/// The largest difference of two covariances, in units of the standard deviations' product.
double apart(const Matrix& P, const Matrix& Q) {
  const Eigen::VectorXd sigma = P.diagonal().cwiseSqrt();
  double out = 0.0;
  for (Eigen::Index i = 0; i < P.rows(); ++i)
    for (Eigen::Index j = 0; j < P.rows(); ++j)
      if (sigma[i] * sigma[j] > 0.0) out = worse(out, std::abs(P(i, j) - Q(i, j)) / (sigma[i] * sigma[j]));
  return out;
}

/// Joseph's form and another one over the same drive: the covariances agree to an epsilon of each of n terms a step, as
/// often of either sign, sqrt(n) together.
StressFigure forms(const std::string& other, const std::string& keys, double noise_scale, double second_order) {
  const Drive drive =
      simulated_drive(5, {.seconds = 10.0, .outage_from_s = 1e9, .noise_scale = noise_scale, .keys = keys.c_str()});
  const ErrorStateFilter joseph = driven(drive, "joseph"), with = driven(drive, other);
  const Matrix P = joseph.covariance(), Q = with.covariance();
  const auto n = static_cast<double>(P.rows()), steps = static_cast<double>(drive.imu.size());
  Worst worst;
  worst.look(Q == Q.transpose() ? 0.0 : stress::kInfinity, 1.0);
  const double rounded = std::sqrt(n) * steps * kEpsilon + second_order;
  worst.look(apart(P, Q), rounded);
  const Eigen::Matrix<double, 9, 1> e = error_of(joseph.nav_state(), with.nav_state());
  const Eigen::VectorXd sigma = P.diagonal().head<9>().cwiseSqrt();
  // An estimate is some sigmas of correction, and beside it a place of 6e6 m.
  for (int i = 0; i < 9; ++i) worst.look(e[i], sigma[i] * rounded + (i < 3 || i > 5 ? 1e-12 : 2e-8));
  return worst.figure();
}

/// NIS of fixes and NEES of the end, twelve drives of which the model is exactly true: mean chi-square, with a false
/// alarm of 1e-6 each side by the bands' own formula (1 %).
StressFigure consistent(const std::string& keys) {
  ConsistencyMean nees, nis;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Drive drive = simulated_drive(
        seed, {.seconds = 15.0, .rate_hz = 20.0, .outage_from_s = 8.0, .outage_to_s = 10.0, .keys = keys.c_str()});
    ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
    filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
    auto fix = drive.fixes.begin();
    for (const ImuSample& imu : drive.imu) {
      filter.predict(imu);
      while (fix != drive.fixes.end() && fix->t <= imu.t) nis.add(filter.update(*fix++).nis, 3);
    }
    const auto e = error_of(drive.truth.back(), filter.nav_state());
    nees.add(normalized_squared(e, filter.covariance().topLeftCorner<9, 9>()), 9);
  }
  Worst worst;
  for (const auto& [mean, dof] : {std::pair{&nees, 9}, {&nis, 3}}) {
    const Band band = mean_chi_square_band(dof, mean->count(), 1e-6);
    const double found = mean->per_state() * dof, middle = 0.5 * (band.low + band.high);
    worst.look(found - middle, 1.01 * (band.high - middle));
  }
  return worst.figure();
}

/// Of the vehicle, m/s^2.
Eigen::Vector3d push() {
  return {0.3, -0.2, 0.1};
}

/// A step as one, and as sixteen of a sixteenth: under constant force and attitude the processes and what they feed are
/// integrated exactly, so that the two agree but for the turn of E within dt, 2 w_e dt of what a tilt moves the place
/// by: g dt^2 / 2 of sigma, sqrt(3 / 4) of the place's own at most; and 16 n roundings.
StressFigure in_parts(double dt_s, double tau_s, const std::vector<std::string>& blocks, const ImuNoise& noise) {
  const FilterConfig config = configured("imu_gain_tau_s = " + number_text(tau_s));
  const NavState at = resting_at(45.0, 7.0, 200.0);
  // No turn against E, so that the attitude stays.
  const Increments whole = rest_increments(at, dt_s);
  const auto covariance = [&](int parts) {
    ErrorState state(blocks, config.own, {.noise = noise});
    state.start(at);
    ErrorPropagation step(state, noise);
    const int n = state.padded_size();
    ErrorMatrix P = ErrorMatrix::Zero(n, n);
    for (int i = 0; i < state.size(); ++i) P(i, i) = i < 9 ? 1e-6 * (1 + i) : 0.0;
    for (const ErrorState::Member& member : state.members())
      for (int i = 0; i < member.block->size(); ++i)
        P(member.offset + i, member.offset + i) = member.block->variance(i);
    step.set_interval(dt_s / parts);
    const Increments in{
        .dt_s = dt_s / parts, .dtheta_U = whole.dtheta_U / parts, .dv_U = whole.dv_U / parts + dt_s / parts * push()};
    const Calibration known = state.step_calibration(step.mean_share());
    for (int k = 0; k < parts; ++k) {
      step.set_step(state, in, known, Eigen::Matrix3d::Zero());
      step.propagate(P);
    }
    return Matrix(P.topLeftCorner(state.size(), state.size()));
  };
  const Matrix once = covariance(1), often = covariance(16);
  const double turn = 2.0 * Wgs84::rate_rad_s * dt_s;
  Worst worst;
  worst.look(once == once.transpose() && often == often.transpose() ? 0.0 : stress::kInfinity, 1.0);
  const double moved = std::min(1.0, 4.91 * dt_s * dt_s * std::sqrt(0.75));
  worst.look(apart(often, once), turn * moved + 16.0 * static_cast<double>(once.rows()) * kEpsilon);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> estimator_cases() {
  const StressMechanism agreement{
      StressGroup::kStiff, "the forms of a covariance over a drive",
      "factors, or errors in other coordinates, that lose what one form keeps",
      "the same covariance and state: an epsilon a term and step, and where coordinates differ the corrections' square",
      "of the bound"};
  const StressMechanism right{StressGroup::kData, "errors of a filter whose model is exactly true",
                              "a covariance that is not that of the errors: each sign, factor and block of the step",
                              "NEES and NIS within their bands of 1e-6", "of the bound"};
  const StressMechanism parts{StressGroup::kStiff, "a step in one or in sixteen parts",
                              "moments of a process over the step that are right to first order only, or lack a term",
                              "the same covariance but for the turn of E within the step", "of the bound"};
  StressRows rows;
  const std::string vehicle =
      "filter = \"vehicle\"\nmeasurements = [\"position\", \"non_holonomic\"]\nacceptance = \"huber\"";
  rows.of(agreement)
      .add("estimator/ud_as_joseph", [] { return forms("ud", "states = [\"biases\", \"gains\"]", 1.0, 0.0); })
      .add("estimator/ud_as_joseph_with_all_of_a_vehicle", [=] { return forms("ud", vehicle, 1.0, 0.0); })
      .add("estimator/invariant_as_joseph_at_small_errors", [] {
        // Errors of 1e-4 of the usual ones: ten corrections of heading by up to 3 sigma of 1.7e-6 rad turn what is
        // kept.
        return forms("invariant", "states = [\"biases\"]", 1e-4, 5e-5);
      });
  rows.of(right);
  rows.add("estimator/errors_are_those_of_the_covariance",
           [] { return consistent("states = [\"biases\", \"gains\"]\nacceptance = \"gate\""); });
  rows.add("estimator/errors_are_those_of_the_covariance_by_factors",
           [] { return consistent("states = [\"in_run_biases\", \"gains\"]\nestimator = \"ud\""); });
  rows.of(parts);
  ImuNoise noise = usual_noise();
  noise.gyro.scale_sigma = noise.accel.scale_sigma = 1e-3;
  noise.gyro.misalignment_sigma_rad = noise.accel.misalignment_sigma_rad = 1e-3;
  for (const double dt_s : {0.01, 1.0})
    for (const double tau_s : {0.1, 100.0}) {
      noise.gyro.in_run_bias_tau_s = tau_s;
      noise.accel.in_run_bias_tau_s = 3.0 * tau_s;
      rows.add("estimator/step_of_" + stress::text(dt_s) + "_s_in_parts_at_tau_" + stress::text(tau_s) + "_s", [=] {
        return in_parts(dt_s, tau_s, {"in_run_biases", "gains", "receiver_clock", "fix_error"}, noise);
      });
    }
  return rows.take();
}

}  // namespace canyon::fusion
