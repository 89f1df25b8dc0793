// Motion from a start that is known exactly, errors with their signs, and what rounding adds to a measurement's noise.
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/measurements/innovation_covariance.h"
#include "canyon/fusion/observers/predicted_motion.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/parts/covariance_distance.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/stress/simulated_drive.h"

namespace canyon::fusion {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// Where the start is known to a millionth of what comes later, the motion since then is as uncertain as the pose
/// itself: what noise and the wheel's readings make of it, each counted once. Variances of 1e-12 m^2 beside
/// 1e-5, and of corrections half of what they turn, which motion by prediction counts to first order.
StressFigure motion_from_a_known_start(bool with_wheel) {
  Looks looks;
  Drive drive = simulated_drive(3, {.seconds = 4.0,
                                    .rate_hz = 20.0,
                                    .outage_from_s = 1e9,
                                    .noise_scale = 1.0,
                                    .keys = "states = [\"biases\", \"wheel_scale\"]\nmeasurements = [\"odometer\"]\n"
                                            "initial_position_sigma_m = 1e-6\ninitial_velocity_sigma_m_s = 1e-6\n"
                                            "initial_attitude_sigma_deg_roll_pitch = 1e-6\n"
                                            "initial_attitude_sigma_deg_heading = 1e-6"});
  drive.lever_U_B = Vector3d(0.3, -0.5, 0.8);
  drive.noise.gyro.white_per_sqrt_hz = 2e-3, drive.noise.accel.white_per_sqrt_hz = 0.05;
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  PredictedMotion motion(filter);
  int taken = 0;
  double turned_rad = 0.0;
  for (const ImuSample& sample : drive.imu) {
    filter.predict(sample), motion.predict(sample);
    if (!with_wheel) continue;
    OdometerSample wheel;
    wheel.t = sample.t;
    wheel.dt_s = sample.dt_s, wheel.speed_m_s = filter.estimate().v_WB_W.norm();
    const std::size_t before = filter.reports().size();
    const Eigen::Quaterniond was = filter.nav_state().R_EU;
    filter.update(AidingMessage(wheel)), motion.update(AidingMessage(wheel));
    turned_rad += was.angularDistance(filter.nav_state().R_EU);
    taken += filter.reports().size() > before ? 1 : 0;
  }
  looks.right(!with_wheel || taken > 3);
  const RelativePose told = motion.motion();
  const Matrix6d P = filter.estimate().pose_covariance;
  looks.right(P(3, 3) > 1e-5);
  looks.near(apart_by_sigma(P, told.covariance), 0.0, 1e-6 + 0.5 * turned_rad);
  looks.right(turned_rad < 0.05);
  return looks.figure();
}

/// Errors are the estimate minus the truth in east, north and up, and about the body's axes; between two states they
/// are those of what lies between. Roundings of places on Earth.
StressFigure signed_errors() {
  Looks looks;
  const NavState rest = resting_at(48.0, 11.0, 300.0);
  const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(rest.p_EU_E));
  const Vector3d off_m(3.0, -2.0, 1.0), fast_m_s(0.3, 0.2, -0.4), turned_rad(0.01, -0.02, 0.03);
  std::vector<NavState> truth, estimate;
  for (int k = 0; k < 5; ++k) {
    NavState t = rest;
    t.t = rest.t + 0.5 * k;
    t.v_EU_E = R * Vector3d(1.0, -2.0, 0.5), t.p_EU_E += 0.5 * k * t.v_EU_E;
    truth.push_back(t);
    NavState e = t;
    e.p_EU_E += R * off_m, e.v_EU_E += R * fast_m_s, e.R_EU = t.R_EU * so3_exp(turned_rad);
    // The estimate's places move with its own speeds, so that what lies between lies on the same straight way.
    e.p_EU_E += 0.5 * k * (R * fast_m_s);
    estimate.push_back(e);
  }
  std::vector<NavState> sparse{estimate[0], estimate[2], estimate[4]};
  for (const auto& from : {estimate, sparse}) {
    const auto errors = navigation_errors(from, truth);
    looks.right(errors.size() == 5);
    Vector3d squares = Vector3d::Zero();
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const double t = 0.5 * static_cast<double>(k);
      // East turns with the place: 3 m of 6e6 m.
      looks.near((errors[k].position_enu_m - (off_m + t * fast_m_s)).norm(), 0.0, 1e-5);
      looks.near((errors[k].velocity_enu_m_s - fast_m_s).norm(), 0.0, 1e-6);
      looks.near((errors[k].attitude_rad - turned_rad).norm(), 0.0, 1e-9);
      if (k > 0) squares += (off_m + t * fast_m_s).cwiseAbs2();
    }
    const NavErrorStatistics found = navigation_error_statistics(errors);
    looks.near((found.position_rms_enu_m - (squares / 4.0).cwiseSqrt()).norm(), 0.0, 1e-5);
    looks.near(found.position_rms_m, std::sqrt(squares.sum() / 4.0), 1e-5);
    looks.near((found.velocity_rms_enu_m_s - fast_m_s.cwiseAbs()).norm(), 0.0, 1e-6);
    looks.near((found.attitude_rms_rad - turned_rad.cwiseAbs()).norm(), 0.0, 1e-9);
    const Vector3d last = off_m + 2.0 * fast_m_s;
    looks.near(found.final_error_m, last.norm(), 1e-5);
    looks.near(found.final_horizontal_m, last.head<2>().norm(), 1e-5);
  }
  return looks.figure();
}

/// What a measurement of almost no noise may be told: its own, and the roundings of H P H'; and where the covariance
/// with a state says more than the prediction's own variance can hold, that and the row's sum too.
StressFigure counted_rounding() {
  Looks looks;
  const FilterConfig config = configured("states = [\"biases\"]");
  ErrorState state({"biases"}, config.own, {.noise = usual_noise()});
  Measurement m(2, state, ErrorIndex::kPosition);
  m.H(0, 3) = 1.0, m.H(1, 4) = 2.0, m.H(1, 5) = -1.0;
  const int n = state.padded_size();
  ErrorMatrix P = ErrorMatrix::Zero(n, n);
  for (int i = 0; i < state.size(); ++i) P(i, i) = 1.0 + i;
  P(3, 4) = P(4, 3) = 0.5;
  const Measurement::Rows HP = rows_of(m.H, P);
  const Measurement::Square predicted = times_transposed(HP, m.H);
  const MatrixXd H = m.H, dense = H * P * H.transpose();
  looks.near((MatrixXd(predicted) - dense).norm() + (MatrixXd(HP) - H * P).norm(), 0.0, 64.0 * kEpsilon * dense.norm());
  looks.right(predicted(0, 1) == predicted(1, 0));
  m.R.setIdentity();
  looks.right(!nearly_exact(m, predicted));
  m.R *= 1e-13;
  looks.right(nearly_exact(m, predicted));
  m.R(0, 0) = 1e-13, m.R(1, 1) = 1.0;
  looks.right(nearly_exact(m, predicted));
  // Consistent: roundings alone, of at most all terms' sigmas squared.
  m.R = 1e-13 * Measurement::Square::Identity(2, 2);
  Measurement honest = m;
  count_rounding(honest, HP, predicted, P);
  for (int i = 0; i < 2; ++i) {
    const double more = honest.R(i, i) - m.R(i, i);
    looks.right(more >= 0.0 && more < 1e3 * kEpsilon * predicted(i, i));
  }
  looks.right(honest.R(0, 1) == m.R(0, 1));
  // A variance that rounding has made a half of what the row demands: HP(0, 3)^2 / P(3, 3) is 4, the prediction 2.
  Measurement::Square too_small = predicted;
  too_small(0, 0) = 0.5 * predicted(0, 0);
  Measurement repaired = m;
  count_rounding(repaired, HP, too_small, P);
  const double least = worse(HP(0, 3) * HP(0, 3) / P(3, 3), HP(0, 4) * HP(0, 4) / P(4, 4));
  looks.near(repaired.R(0, 0) - honest.R(0, 0), least + std::abs(too_small(0, 0)) + std::abs(too_small(0, 1)), 1e-12);
  looks.near(repaired.R(1, 1), honest.R(1, 1), 1e-12);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> known_start_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "what is known exactly at the start, and by which sign an error is told",
           .why = "noise that is counted with another sign or twice, an error of the other sign, a square taken anew",
           .expected = "the filter's own covariance, errors that were laid out, dense products: first order, roundings",
           .unit = "of the bound",
           .loose = "some bounds are those of places on Earth"});
  rows.add("starts/motion_from_a_known_start", [] { return motion_from_a_known_start(false); });
  rows.add("starts/motion_from_a_known_start_with_a_wheel", [] { return motion_from_a_known_start(true); });
  rows.add("starts/signed_errors", signed_errors).add("starts/counted_rounding", counted_rounding);
  return rows.take();
}

}  // namespace canyon::fusion
