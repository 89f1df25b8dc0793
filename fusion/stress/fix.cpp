#include <vector>

#include <Eigen/Eigenvalues>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kEpsilon;

RestingFilter after_a_second(const FilterConfig& config = {}) {
  RestingFilter rest(config, usual_noise(), 100.0);
  for (int k = 0; k < 100; ++k) rest.predict();
  return rest;
}

/// State and covariance as they stand, to be compared to the bit.
struct Standing {
  NavState state;
  Eigen::MatrixXd P;
  explicit Standing(const ErrorStateFilter& f) : state(f.nav_state()), P(f.covariance()) {}
  bool same(const ErrorStateFilter& f) const {
    const NavState& s = f.nav_state();
    return s.t == state.t && s.p_EU_E == state.p_EU_E && s.v_EU_E == state.v_EU_E &&
           s.R_EU.coeffs() == state.R_EU.coeffs() && f.covariance() == P;
  }
};

/// 1 where the fix is let through, or refused in other words, or refused and yet something changed.
int let_through(RestingFilter& rest, const GnssFix& fix, const char* words) {
  const Standing before(rest.filter);
  return stress::not_refused([&] { rest.filter.update(fix); }, words) + (before.same(rest.filter) ? 0 : 1);
}

/// A fix that is known exactly, or exactly along one way: a covariance that is not positive definite.
StressFigure rank_deficient_fixes() {
  RestingFilter rest = after_a_second();
  int passed = 0;
  const Vector3d one = Vector3d(1.0, 2.0, -2.0) / 3.0;
  for (const Matrix3d& R :
       {Matrix3d(Matrix3d::Zero()), Matrix3d(one * one.transpose()), Matrix3d(Vector3d(1.0, 1.0, 0.0).asDiagonal()),
        Matrix3d(-Matrix3d::Identity()), Matrix3d(Vector3d(1.0, -1e-30, 1.0).asDiagonal())}) {
    GnssFix fix = rest.fix(1.0);
    fix.covariance_E = R;
    passed += let_through(rest, fix, "covariance of the GNSS fix at ");
  }
  return {1.0 * passed, 0.0};
}

/// A fix a million million times better than the position: the variance that is left is the fix's, the rest of the
/// correlations is rounding; after the next prediction the position's variance has grown by the velocity's times dt^2,
/// and the correlations are definite again. Twice at one instant too.
StressFigure nearly_perfect_fixes(double sigma_m) {
  RestingFilter rest = after_a_second();
  stress::Worst worst;
  for (int round = 0; round < 20; ++round) {
    for (int again = 0; again < 2; ++again) {
      rest.filter.update(rest.fix(sigma_m));
      const auto P = rest.filter.covariance();
      worst.look(P == P.transpose() && P.allFinite() ? 0.0 : stress::kInfinity, 1.0);
      // The antenna's variance: that of the fix, and roundings of what makes it, lever arms and attitude.
      const double about =
          kEpsilon * 100.0 * P.diagonal().segment<3>(ErrorIndex::kTheta).maxCoeff<Eigen::PropagateNaN>();
      const auto llt = Matrix3d(P.block<3, 3>(3, 3)).llt();
      worst.look(llt.info() == Eigen::Success || sigma_m * sigma_m < about ? 0.0 : stress::kInfinity, 1.0);
    }
    rest.predict();
    const Matrix3d v = rest.filter.covariance().block<3, 3>(6, 6), p = rest.filter.covariance().block<3, 3>(3, 3);
    const double least = Eigen::SelfAdjointEigenSolver<Matrix3d>(p).eigenvalues().minCoeff<Eigen::PropagateNaN>();
    const double white = std::pow(5e-4, 2) * 1e-6 / 3.0;  // what the white noise alone makes of it, N^2 dt^3 / 3
    worst.look(least > 0.5 * white && v.llt().info() == Eigen::Success ? 0.0 : stress::kInfinity, 1.0);
  }
  return {worst.figure().figure, 0.0};
}

/// Fixes of a millimetre that contradict one another by `apart_m`, in turn: every number stays one, and each update
/// tells by how much it was surprised.
StressFigure contradictory_fixes(double apart_m) {
  RestingFilter rest = after_a_second();
  int wrong = 0;
  for (int k = 0; k < 400; ++k) {
    rest.predict();
    if (k % 10 != 0) continue;
    GnssFix fix = rest.fix(1e-3);
    fix.p_A_E.x() += k % 20 == 0 ? apart_m : 0.0;
    const UpdateReport report = rest.filter.update(fix);
    const auto P = rest.filter.covariance();
    wrong += report.innovation.allFinite() && std::isfinite(report.nis) && report.nis >= 0.0 ? 0 : 1;
    wrong += P.allFinite() && P == P.transpose() && (P.diagonal().array() > 0.0).all() ? 0 : 1;
    wrong += rest.filter.nav_state().p_EU_E.allFinite() ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// With a gate of 5 sigma an outlier of any size is told as not accepted, and changes nothing.
StressFigure outliers() {
  const FilterConfig config = configured("gate_sigma = 5");
  RestingFilter rest = after_a_second(config);
  int wrong = 0;
  for (const double off_m : {100.0, 1e9, -1e9, 1e30, 1e150, -1e200, 1e300}) {
    GnssFix fix = rest.fix(1.0);
    fix.p_A_E.y() += off_m;
    const Standing before(rest.filter);
    const UpdateReport report = rest.filter.update(fix);
    wrong += !report.accepted && report.dimension == 3 && before.same(rest.filter) ? 0 : 1;
  }
  wrong += rest.filter.update(rest.fix(1.0)).accepted ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Every number of a fix that the filter uses, not a number and infinite in turn; and a fix that is none changes
/// nothing whatever is in it.
StressFigure not_finite_fixes() {
  RestingFilter rest = after_a_second();
  int passed = 0;
  for (const double bad : {std::nan(""), stress::kInfinity, -stress::kInfinity}) {
    for (int i = 0; i < 3; ++i) {
      GnssFix fix = rest.fix(1.0);
      fix.p_A_E[i] = bad;
      passed += let_through(rest, fix, "GNSS fix at ");
      fix.status = FixStatus::kNone;
      const Standing before(rest.filter);
      passed += rest.filter.update(fix).dimension == 0 && before.same(rest.filter) ? 0 : 1;
    }
    for (int i = 0; i < 9; ++i) {
      GnssFix fix = rest.fix(1.0);
      fix.covariance_E(i / 3, i % 3) = bad;
      passed += let_through(rest, fix, "GNSS fix at ");
    }
  }
  return {1.0 * passed, 0.0};
}

/// From 0.1 s before the last sample to 0.1 s after it is taken, carried by the velocity; beside that it is refused.
StressFigure late_and_early_fixes() {
  int wrong = 0;
  for (const std::int64_t age_ns : {-100'000'000, -1, 0, 1, 99'999'999, 100'000'000}) {
    RestingFilter rest = after_a_second();
    GnssFix fix = rest.fix(1.0);
    fix.t.ns += age_ns;
    wrong += rest.filter.update(fix).accepted ? 0 : 1;
  }
  RestingFilter rest = after_a_second();
  for (const std::int64_t age_ns :
       {-100'000'001LL, 100'000'001LL, -86'400'000'000'000LL, 86'400'000'000'000LL, 1LL << 60}) {
    GnssFix fix = rest.fix(1.0);
    fix.t.ns += age_ns;
    wrong += let_through(rest, fix, " s away from the last IMU sample");
  }
  return {1.0 * wrong, 0.0};
}

/// Four hours without a fix: the position is not known on Earth. The first fix takes its place, to its own sigma, and
/// the ones after it are taken as usual.
StressFigure after_hours_without() {
  RestingFilter rest({}, usual_noise(), 1.0);
  for (int k = 0; k < 4 * 3600; ++k) rest.predict();
  int wrong = 0;
  const UpdateReport first = rest.filter.update(rest.fix(1.0));
  wrong += first.accepted && first.dimension == 0 ? 0 : 1;
  const auto P = rest.filter.covariance();
  const GnssFix here = rest.fix(1.0);
  const NavState& s = rest.filter.nav_state();
  wrong += (s.p_EU_E + s.R_EU * Vector3d(0.3, -0.1, 1.2) - here.p_A_E).norm() < 1e-6 ? 0 : 1;
  wrong +=
      P.allFinite() && P == P.transpose() && P.diagonal().segment<3>(3).maxCoeff<Eigen::PropagateNaN>() < 10.0 ? 0 : 1;
  for (int k = 0; k < 60; ++k) {
    rest.predict();
    wrong += rest.filter.update(rest.fix(1.0)).dimension == 3 ? 0 : 1;
  }
  const Eigen::Matrix3d p = rest.filter.covariance().block<3, 3>(3, 3);
  wrong += p.llt().info() == Eigen::Success && p.diagonal().maxCoeff<Eigen::PropagateNaN>() < 2.0 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Position and velocity along one axis, pushed by white noise N^2, in a field that pulls back by w^2 a metre (pushes
/// away if that is negative): the textbook's two states, by themselves.
struct TwoStates {
  double pp, pv = 0.0, vv;
  void predict(double dt, double w2, double N2) {
    const double a = 1.0 - 0.5 * w2 * dt * dt, c = -w2 * dt;
    const double pp_ = a * a * pp + 2.0 * a * dt * pv + dt * dt * vv, vv_ = c * c * pp + 2.0 * a * c * pv + a * a * vv;
    pv = a * c * pp + (a * a + c * dt) * pv + a * dt * vv + N2 * dt * dt / 2.0;
    pp = pp_ + N2 * dt * dt * dt / 3.0;
    vv = vv_ + N2 * dt;
  }
  void update(double R) {
    const double S = pp + R;
    vv -= pv * pv / S;
    pv *= R / S;
    pp *= R / S;
  }
};

/// Fixes of a metre at this rate, the accelerometer's white noise alone to carry over from one to the next: variances
/// along east, north and up against those of two states. They remember for T = max(1 / rate, (s^2 / rate / N^2)^(1/4)),
/// twice which is what the rest has time for: Coriolis, which couples the axes by 2 w_e (2 T) and the variances by its
/// square; flattening and the Earth's turn, 1 % of the field's pull; the start's tilt of 1e-6 degrees; rounding.
StressFigure fixes_at(double rate_hz) {
  constexpr double kN = 1e-3, kStart_m = 10.0, kStart_m_s = 1.0, kTilt_deg = 1e-6;
  ImuNoise noise;
  noise.accel.white_per_sqrt_hz = kN;
  FilterConfig config;
  config.initial_attitude_sigma_deg_roll_pitch = config.initial_attitude_sigma_deg_heading = kTilt_deg;
  config.initial_position_sigma_m = kStart_m;
  config.initial_velocity_sigma_m_s = kStart_m_s;
  const double imu_hz = std::max(rate_hz, 100.0), fix_s = 1.0 / rate_hz;
  const double memory_s = worse(fix_s, std::pow(fix_s / (kN * kN), 0.25));
  RestingFilter rest(config, noise, imu_hz);
  const auto each = static_cast<std::int64_t>(std::llround(imu_hz / rate_hz));
  const auto steps = each * static_cast<std::int64_t>(std::max(20.0, std::ceil(10.0 * memory_s / fix_s)));
  const double g = 9.81, radius_m = 6.37e6;
  TwoStates axes[3];
  for (TwoStates& axis : axes) axis = {.pp = kStart_m * kStart_m, .vv = kStart_m_s * kStart_m_s};
  int wrong = 0;
  for (std::int64_t k = 1; k <= steps; ++k) {
    rest.predict();
    for (int i = 0; i < 3; ++i) axes[i].predict(1.0 / imu_hz, (i < 2 ? 1.0 : -2.0) * g / radius_m, kN * kN);
    if (k % each != 0 || k == steps) continue;
    wrong += rest.filter.update(rest.fix(1.0)).dimension == 3 ? 0 : 1;
    for (TwoStates& axis : axes) axis.update(1.0);
  }
  const Matrix3d R_WE = rest.frame.R_EW().transpose();
  const Eigen::MatrixXd P = rest.filter.covariance();
  const Matrix3d p = R_WE * P.block<3, 3>(3, 3) * R_WE.transpose(), v = R_WE * P.block<3, 3>(6, 6) * R_WE.transpose();
  const double reach_s = 2.0 * memory_s, turn = std::pow(2.0 * Wgs84::rate_rad_s * reach_s, 2);
  const double pull = 0.01 * 2.0 * g / radius_m * reach_s * reach_s, tilt = g * kTilt_deg * kDegree;
  const double rounding = 10.0 * kEpsilon * static_cast<double>(steps);
  stress::Worst worst;
  worst.look(wrong == 0 && P == P.transpose() ? 0.0 : stress::kInfinity, 1.0);
  for (int i = 0; i < 3; ++i) {
    const double tilted_v = std::pow(tilt * reach_s, 2) / axes[i].vv,
                 tilted_p = std::pow(0.5 * tilt * reach_s * reach_s, 2) / axes[i].pp;
    worst.look(p(i, i) / axes[i].pp - 1.0, turn + pull + tilted_p + rounding);
    worst.look(v(i, i) / axes[i].vv - 1.0, turn + pull + tilted_v + rounding);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> fix_cases() {
  const auto group = StressGroup::kData;
  const StressMechanism rank{group, "a covariance without full rank",
                             "R = 0 makes the innovation's covariance singular once P is, and its inverse "
                             "infinite",
                             "is refused by name, before anything has changed", "let through"};
  const StressMechanism perfect{
      group, "a fix that leaves no variance",
      "what is left of P is rounding, of either sign, and the next innovation's "
      "covariance may not be definite (found by this case, 2026-11-22: an internal error)",
      "P stays symmetric and its position definite, and the next prediction gives it back at least "
      "the white noise's part",
      "looks"};
  const StressMechanism contradiction{group, "fixes that contradict one another",
                                      "velocities of 10^11 m/s, and a NIS that overflows",
                                      "state, covariance and NIS stay numbers", "looks"};
  const StressMechanism outlier{group, "an outlier beyond the square root of what a double holds",
                                "its square is infinite, the tail of infinity no number, and a "
                                "comparison with that lets it pass (found by this case, 2026-11-22)",
                                "not accepted, and nothing changed, to the bit", "fixes"};
  const StressMechanism broken{group, "a fix that is not finite", "one number spoils state and covariance for good",
                               "each of its numbers in turn is refused, before anything has changed", "let through"};
  const StressMechanism late{group, "a fix before or after the filter's time",
                             "a delayed fix is taken for the present one, or one of tomorrow",
                             "taken within 0.1 s, to the nanosecond, and refused beside it", "fixes"};
  const StressMechanism lost{StressGroup::kLong, "a position that is not known on Earth",
                             "gravity linear over 10^7 m pulls the update anywhere",
                             "the first fix takes the position's place, and the filter goes on", "looks"};
  const StressMechanism rates{StressGroup::kStiff, "fixes at rates from 0.01 to 1000 Hz",
                              "noise per fix in place of per root hertz, a fix too many or too few, an update that "
                              "loses what the last thousand told",
                              "position and velocity as a filter of these two states has them, to what Coriolis and "
                              "flattening do within what it remembers",
                              "of the bound"};
  StressRows rows;
  rows.of(rank).add("fix/rank_deficient_covariance", rank_deficient_fixes);
  rows.of(outlier).add("fix/outliers_to_1e300_m", outliers);
  rows.of(broken).add("fix/not_finite_field_by_field", not_finite_fixes);
  rows.of(late).add("fix/late_and_early", late_and_early_fixes);
  rows.of(lost).add("fix/after_4_h_without", after_hours_without);
  for (const double sigma_m : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15})
    rows.of(perfect).add("fix/sigma_" + stress::text(sigma_m) + "_m", [=] { return nearly_perfect_fixes(sigma_m); });
  for (const double rate_hz : {0.01, 1.0, 100.0, 1000.0})
    rows.of(rates).add("fix/rate_" + stress::text(rate_hz) + "_hz", [=] { return fixes_at(rate_hz); });
  for (const double apart_m : {1.0, 1e5, 1e9})
    rows.of(contradiction).add("fix/contradiction_of_" + stress::text(apart_m) + "_m", [=] {
      return contradictory_fixes(apart_m);
    });
  return rows.take();
}

}  // namespace canyon::fusion
