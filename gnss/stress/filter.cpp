// The receiver's filter of position, velocity and time, and the smoothing of codes by their carrier.
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "canyon/core/earth/earth.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/solver/carrier_smoothing.h"
#include "canyon/gnss/solver/pvt_filter.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
const GpsTime kFirstEpoch = GpsTime::from_week_sow(1617, 388800.0);
const Geodetic kReceiverAt{0.5646, -1.586, 60.0};
const Eigen::Vector3d kVelocity_E(6.0, -8.0, 3.0);
constexpr double kReceiverClock_m = 3e4, kDrift_m_s = 12.0;

struct Measured {
  std::vector<RangeMeasurement> ranges;
  std::vector<RateMeasurement> rates;
  Eigen::Vector3d truth_E;
};

/// Eight satellites that stand still over the receiver's start; it moves straight on; nothing has an error.
Measured exact(double t_s, double sigma_m) {
  Measured out;
  const Eigen::Vector3d start_E = ecef_from_geodetic(kReceiverAt);
  out.truth_E = start_E + t_s * kVelocity_E;
  const Eigen::Matrix3d R = rotation_E_from_enu(kReceiverAt);
  for (int k = 0; k < 8; ++k) {
    const double e = 0.25 + 0.15 * k, a = 2.4 * k;
    const Eigen::Vector3d p_E =
        start_E + 2.2e7 * (R * Eigen::Vector3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)));
    const double range_m = (p_E - out.truth_E).norm();
    RangeMeasurement r;
    r.p_E = turned_by_earth(p_E, -range_m / kSpeedOfLight);
    r.range_m = range_m + kReceiverClock_m + kDrift_m_s * t_s;
    r.sigma_m = sigma_m;
    out.ranges.push_back(r);
    // At rest in E of reception: its velocity in E of transmission is none.
    RateMeasurement m{r.p_E, Eigen::Vector3d::Zero(), 0.0, std::max(0.1 * sigma_m, 1e-6)};
    m.rate_m_s = range_rate_m_s(m, out.truth_E, kVelocity_E) + kDrift_m_s;
    out.rates.push_back(m);
  }
  return out;
}

/// Worst of: how far from symmetric, how far below zero its least eigenvalue, over its largest. Infinite if not finite.
double not_positive(const Eigen::Matrix<double, 6, 6>& P) {
  if (!P.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(P);
  const double largest = eigen.eigenvalues().maxCoeff<Eigen::PropagateNaN>();
  const double skew = (P - P.transpose()).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / largest;
  return worse(skew, -eigen.eigenvalues().minCoeff<Eigen::PropagateNaN>() / largest);
}

/// Of an innovation, times GDOP.
constexpr double kPositionRounding_m = 8.0 * kEpsilon * 2.2e7 * 4.0;

/// After `updates` of exact measurements of that sigma. Joseph's form is symmetric and positive but for the rounding of
/// products of eleven terms, 3 * 11 eps of the largest element, from one update to the next: it contracts. Meanwhile
/// the position stays as exact as exact_position() says. In units of these bounds.
StressFigure covariance(double sigma_m, double interval_s, int updates) {
  PvtFilter filter{{}};
  StressFigure out{0.0, 1.0};
  for (int k = 0; k < updates; ++k) {
    const Measured now = exact(interval_s * (k % 50), sigma_m);
    if (k % 50 == 0) filter.reset();
    const auto found = filter.update(kFirstEpoch + interval_s * k, now.ranges, now.rates, now.truth_E);
    if (!found.ok) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
    take_worst(out, not_positive(found.covariance) / (64.0 * kEpsilon));
    take_worst(out, (found.p_E - now.truth_E).norm() / (2.0 * kPositionRounding_m));
  }
  return out;
}

/// Position of exact measurements. Each innovation is rounding, 8 eps range = 4e-8 m; the gain sums at most GDOP = 4 of
/// it, and the prediction that it corrects carries as much.
StressFigure exact_position(double sigma_m, double interval_s) {
  PvtFilter filter{{}};
  StressFigure out{0.0, 2.0 * kPositionRounding_m};
  for (int k = 0; k < 50; ++k) {
    const Measured now = exact(interval_s * k, sigma_m);
    const auto found = filter.update(kFirstEpoch + interval_s * k, now.ranges, now.rates, now.truth_E);
    take_worst(out, found.ok ? (found.p_E - now.truth_E).norm() : kNaN);
  }
  return out;
}

/// An epoch again, one from before, one far too late: each begins anew and none predicts over that time; a figure
/// counts estimates that are not finite or do not say so.
StressFigure odd_times() {
  StressFigure out;
  for (const double dt : {0.0, -1.0, -1e6, 121.0, 1e8}) {
    PvtFilter filter{{}};
    const Measured first = exact(0.0, 1.0), second = exact(1.0, 1.0);
    filter.update(kFirstEpoch, first.ranges, first.rates, first.truth_E);
    const auto found = filter.update(kFirstEpoch + dt, second.ranges, second.rates, second.truth_E);
    const bool good = found.ok && found.begun_anew && found.covariance.allFinite() && found.p_E.allFinite();
    out.figure += good ? 0.0 : 1.0;
  }
  return out;
}

/// Field by field, what is not finite among seven good ranges and rates: a filter that runs leaves it out by its gate,
/// one that begins refuses it by a check. A figure counts estimates that are not finite or took it, and what is let
/// through.
StressFigure no_number_filtered() {
  StressFigure out;
  for (const bool running : {true, false})
    for (const double bad : {kNaN, std::numeric_limits<double>::infinity()})
      for (int field = 0; field < 6; ++field) {
        PvtFilter filter{{}};
        const Measured first = exact(0.0, 1.0);
        if (running) filter.update(kFirstEpoch, first.ranges, first.rates, first.truth_E);
        Measured next = exact(1.0, 1.0);
        if (field == 0) next.ranges[3].range_m = bad;
        if (field == 1) next.ranges[3].p_E.x() = bad;
        if (field == 2) next.ranges[3].sigma_m = bad;
        if (field == 3) next.rates[3].rate_m_s = bad;
        if (field == 4) next.rates[3].v_E.z() = bad;
        if (field == 5) next.rates[3].sigma_m_s = bad;
        const auto update = [&] { return filter.update(kFirstEpoch + 1.0, next.ranges, next.rates, next.truth_E); };
        if (!running) {
          out.figure += stress::not_refused(update, field < 3 ? "range_m = " : "rate_m_s = ");
          continue;
        }
        const auto found = update();
        const bool good = found.ok && !found.begun_anew && found.p_E.allFinite() && found.v_E.allFinite() &&
                          found.covariance.allFinite() && (found.p_E - next.truth_E).norm() < 1.0;
        out.figure += good && !(field < 3 && found.ranges_used[3]) ? 0.0 : 1.0;
      }
  return out;
}

/// Without any measurement: the variance of position after n predictions of dt is that of the integrated white
/// acceleration and of the velocity's start, whatever the steps: P_v t^2 + q t^3 / 3.
StressFigure predictions(double interval_s) {
  constexpr double kSpan_s = 100.0;
  const PvtFilterParameters p{.longest_gap_s = 1e9};
  PvtFilter filter{p};
  const Measured first = exact(0.0, 1.0);
  const auto begun = filter.update(kFirstEpoch, first.ranges, first.rates, first.truth_E);
  PvtFilter::Estimate last;
  const auto steps = static_cast<int>(std::lround(kSpan_s / interval_s));
  for (int k = 1; k <= steps; ++k) last = filter.update(kFirstEpoch + k * (kSpan_s / steps), {}, {}, first.truth_E);
  const Eigen::Matrix3d expected =
      begun.covariance.topLeftCorner<3, 3>() + kSpan_s * kSpan_s * begun.covariance.bottomRightCorner<3, 3>() +
      Eigen::Matrix3d::Identity() * std::pow(p.acceleration_m_s2, 2) * std::pow(kSpan_s, 3) / 3.0;
  const double error = (last.covariance.topLeftCorner<3, 3>() - expected).norm() / expected.norm();
  return {error, (64.0 + 8.0 * steps) * kEpsilon};
}

SatelliteId sv() {
  return {GnssSystem::kGps, 5};
}

/// A code without noise, whose phase has an offset of 1e8 m, one unit in whose last place is 1.5e-8 m. Each of the
/// running mean's updates rounds by up to half of that (deviation unit / sqrt 12) and forgets as 1 - 1/N: sqrt(N / 2)
/// of it in all, five deviations; and the sums at its ends two units.
StressFigure long_arc(int epochs, double time_constant_s) {
  CarrierSmoothing smoothing(time_constant_s);
  const double unit_m = std::ldexp(1.0, -26);
  StressFigure out{0.0, unit_m * (5.0 * std::sqrt(std::min<double>(epochs, time_constant_s) / 24.0) + 2.0)};
  for (int k = 0; k < epochs; ++k) {
    const double range_m = 2.2e7 + 700.0 * std::sin(1e-4 * k) + 0.3 * k;
    const auto got = smoothing.smooth(sv(), kFirstEpoch + k, {.code_m = range_m, .phase_m = range_m - 1e8});
    take_worst(out, std::abs(got.code_m - range_m));
  }
  return out;
}

/// Hatch's divergence: an ionosphere that grows by `rate` lags by 2 rate (N - 1) epochs in the steady state, from which
/// e^-k/N of the beginning is left after k epochs.
StressFigure divergence(double rate_m_s) {
  constexpr double kN = 100.0;
  constexpr int kEpochs = 4000;
  CarrierSmoothing smoothing(kN);
  double bias_m = 0.0;
  for (int k = 0; k <= kEpochs; ++k) {
    const double ionosphere_m = rate_m_s * k, range_m = 2.2e7;
    bias_m =
        smoothing.smooth(sv(), kFirstEpoch + k, {.code_m = range_m + ionosphere_m, .phase_m = range_m - ionosphere_m})
            .code_m -
        range_m - ionosphere_m;
  }
  const double closed_m = -2.0 * rate_m_s * (kN - 1.0);
  return {std::abs(bias_m - closed_m),
          std::abs(closed_m) * kN * std::exp(-(kEpochs - kN) / kN) + 0.5 * kN * kEpsilon * 2.2e7};
}

}  // namespace

std::vector<StressCase> filter_cases() {
  StressRows rows;
  rows.of(
      {StressGroup::kData, "a filter's covariance at the ends of its noise",
       "a measurement far better than the prediction: the difference of nearly equal matrices turns negative or skew",
       "symmetric and positive but for 64 eps of its largest element (Joseph's form, eleven terms)", "of the largest"});
  for (const double sigma : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    rows.add(printed("filter/covariance_at_sigma_%.0e_m", sigma), [sigma] { return covariance(sigma, 1.0, 400); });
  }
  rows.add("filter/covariance_after_300000_updates", [] { return covariance(0.5, 0.1, 300000); }).long_running();

  rows.of({StressGroup::kStiff, "a filter of exact measurements",
           "S = H P H' + R of a condition of 1e18: the gain is rounding, and pulls the state away",
           "the true place to 2 GDOP * 8 eps range, after each of 50 updates", "m"});
  for (const double sigma : {1e-6, 1e-3, 1.0, 1e3}) {
    rows.add(printed("filter/place_at_sigma_%.0e_m", sigma), [sigma] { return exact_position(sigma, 1.0); });
  }
  rows.add("filter/place_at_100_hz", [] { return exact_position(1.0, 0.01); }).add("filter/place_at_0.01_hz", [] {
    return exact_position(1.0, 100.0);
  });

  rows.of({StressGroup::kData, "epochs again, backwards, or after a gap",
           "a prediction over no time, back in time or over years makes the covariance zero, negative or endless",
           "each begins anew with finite numbers", "not anew"});
  rows.add("filter/odd_times", odd_times);
  rows.of({StressGroup::kData, "a range or rate that is not finite, in a filter that runs",
           "a gate that compares NaN lets it pass, and every later estimate is NaN",
           "left out where it runs, refused where it begins, field by field", "taken"});
  rows.add("filter/not_finite_field_by_field", no_number_filtered);

  rows.of({StressGroup::kStiff, "predictions in many small steps or one",
           "a noise that is scaled by the wrong power of the step", "P_p + P_v t^2 + q t^3 / 3 to (64 + 8 n) eps", ""});
  for (const double dt : {0.01, 1.0, 100.0}) {
    rows.add(printed("filter/predictions_of_%g_s", dt), [dt] { return predictions(dt); });
  }

  rows.of({StressGroup::kLong, "a running mean over a long arc",
           "a mean by sum over count loses digits as both grow; one that never forgets drifts",
           "code without noise comes back to 5 sqrt(N / 24) + 2 units in the last place of the offset", "m"});
  rows.add("filter/smoothing_100_s_over_a_day", [] { return long_arc(86400, 100.0); })
      .add("filter/smoothing_1000_s_over_a_day", [] { return long_arc(86400, 1000.0); })
      .add("filter/smoothing_100_s_over_100_epochs", [] { return long_arc(100, 100.0); });

  rows.of({StressGroup::kLong, "code and carrier that diverge",
           "the lag of a running mean behind a ramp, its sign or a count off by one",
           "-2 rate (N - 1) epochs; e^-39 of the beginning and N eps / 2 are left", "m"});
  rows.add("filter/divergence_of_1_mm_s", [] { return divergence(1e-3); }).add("filter/divergence_of_5_cm_s", [] {
    return divergence(-0.05);
  });
  return rows.take();
}

}  // namespace canyon::gnss
