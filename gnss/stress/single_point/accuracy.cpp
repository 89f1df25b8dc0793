// How good positions are, and how good they are said to be: statistics of fixes, and the sigmas that a receiver
// reports.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/messages.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/single_point/position_statistics.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/reported_covariance.h"
#include "canyon/gnss/stress/single_point/stated_variance.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

double rank(std::vector<double> x, double share) {
  std::sort(x.begin(), x.end());
  const double at = share * static_cast<double>(x.size() - 1), below = std::floor(at);
  const auto i = static_cast<std::size_t>(below);
  return i + 1 < x.size() ? (1.0 - (at - below)) * x[i] + (at - below) * x[i + 1] : x[i];
}

/// n fixes about a place: means, deviations about them, percentiles, ellipses and velocities against sums over the
/// errors that were put in, to the rounding of places in E, 4 eps of 6.4e6 m, and a thousandth of it for velocities.
StressFigure statistics_of(int n) {
  const Vector3d truth_E = ecef_from_geodetic({0.5, 1.0, 10.0}), v_E(3.0, -2.0, 7.0);
  const Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(truth_E));
  const RandomStream draws(3, "stress.positions");
  std::vector<GnssFix> fixes;
  std::vector<Vector3d> errors, velocity_errors;
  std::vector<double> level, upright, squares;
  double log_sum = 0.0;
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    GnssFix fix;
    fix.t = GpsTime::from_week_sow(2000, 1.0 * k);
    fixes.push_back(fix);  // none
    fix.status = FixStatus::kSingle;
    const Vector3d e(1.0 + 2.0 * draws.normal(0, i), -3.0 + draws.normal(1, i), 5.0 * draws.normal(2, i));
    const Vector3d u(0.1 * draws.normal(3, i), 0.3 + 0.1 * draws.normal(4, i), 0.2 * draws.normal(5, i));
    Matrix3d P;
    P << 4.0, 0.6, 0.1, 0.6, 2.0, -0.2, 0.1, -0.2, 20.0;
    fix.p_A_E = truth_E + R * e;
    fix.v_A_E = v_E + R * u;
    fix.covariance_E = R * P * R.transpose();
    fixes.push_back(fix);
    errors.push_back(e), velocity_errors.push_back(u);
    level.push_back(std::sqrt(e.x() * e.x() + e.y() * e.y()));
    upright.push_back(std::abs(e.z()));
    const double det = 4.0 * 2.0 - 0.36;
    squares.push_back((2.0 * e.x() * e.x() - 1.2 * e.x() * e.y() + 4.0 * e.y() * e.y()) / det);
    log_sum -= 0.5 * squares.back() + 0.5 * std::log(4.0 * kPi * kPi * det);
    fix.t = fix.t + 0.5;
    fixes.push_back(fix);  // without a truth
  }
  const PositionStatistics s = position_statistics(fixes, [&](GpsTime t) {
    return t.ns % 1'000'000'000 == 0 ? std::optional(TruePlace{truth_E, v_E}) : std::nullopt;
  });
  Looks looks;
  looks.right(s.epochs == 3 * n && s.solved == 2 * n && s.compared == n);
  Vector3d mean = Vector3d::Zero(), about = Vector3d::Zero(), square = Vector3d::Zero(), fast = Vector3d::Zero();
  for (const Vector3d& e : errors) mean += e / n;
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    for (int a = 0; a < 3; ++a) {
      about[a] += squared(errors[i][a] - mean[a]) / n;
      square[a] += squared(errors[i][a]) / n;
      fast[a] += squared(velocity_errors[i][a]) / n;
    }
  }
  const double grain_m = 4.0 * kEpsilon * 6.4e6;
  for (int a = 0; a < 3; ++a) {
    looks.near(s.mean_enu_m[a], mean[a], grain_m);
    looks.near(s.std_enu_m[a], std::sqrt(about[a]), grain_m);
    looks.near(s.velocity_rms_enu_m_s[a], std::sqrt(fast[a]), 1e-3 * grain_m);
  }
  looks.near(s.rms_3d_m, std::sqrt(square.sum()), grain_m);
  looks.near(s.h50_m, rank(level, 0.5), grain_m);
  looks.near(s.h95_m, rank(level, 0.95), grain_m);
  looks.near(s.v95_m, rank(upright, 0.95), grain_m);
  for (const double share : {0.3, 0.5, 0.95, 0.997}) {
    const double within = -2.0 * std::log1p(-share);
    const auto inside = std::count_if(squares.begin(), squares.end(), [&](double q) { return q <= within; });
    looks.near(s.reported.inside(share), static_cast<double>(inside) / n, 1e-12);
  }
  const auto beyond3 = std::count_if(squares.begin(), squares.end(), [](double q) { return q > 9.0; });
  looks.near(s.reported.beyond_3_sigma(), static_cast<double>(beyond3) / n, 1e-12);
  // Squares of errors over 1.4 m of sigma, each to 10 grains.
  looks.near(s.reported.log_score(), log_sum / n, 20.0 * grain_m);
  return looks.figure();
}

/// Ranges from eight directions, with errors of known size; sigmas that differ.
std::vector<RangeMeasurement> eight_ranges(const Vector3d& at_E, double error_m, std::uint64_t k) {
  const Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(at_E));
  const RandomStream draws(7, "stress.ranges");
  const double sky[8][2] = {{10, 70}, {60, 25}, {120, 40}, {190, 15}, {230, 55}, {300, 30}, {340, 12}, {90, 80}};
  std::vector<RangeMeasurement> out;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double a = sky[i][0] * kDegree, e = sky[i][1] * kDegree;
    RangeMeasurement r;
    r.p_E = at_E + 2.2e7 * (R * Vector3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)));
    r.sigma_m = 1.0 + 0.2 * i;
    r.range_m = line_of_sight(r.p_E, at_E).range_m + 300.0 + error_m * draws.normal(i, k);
    out.push_back(r);
  }
  return out;
}

/// Sigmas by hand from z = Q' e: an environment's are the root of the weighted mean of three variances, with the
/// likelihoods exp(-(z' S^-1 z + ln det S) / 2); inflated ones all larger by the root of z' S^-1 z over its degrees.
/// Solutions of 4 x 4 systems of condition 1e3: 1e-10.
StressFigure reported_sigmas() {
  Looks looks;
  const Vector3d at_E = ecef_from_geodetic({0.56, -1.58, 60.0});
  for (const double error_m : {0.3, 4.0, 25.0})
    for (const double cn0 : {48.0, 36.0, kNaN}) {
      const auto ranges = eight_ranges(at_E, error_m, 5);
      const PositionSolution s = make_least_squares({})->solve(ranges, at_E);
      if (!s.ok) return {kInfinity, 1.0};
      std::vector<RangeSignal> signals;
      for (std::uint32_t i = 0; i < 8; ++i) signals.push_back({i, cn0, i % 2 == 0 ? 1.0 : 2.6});
      const RangeEvidence e = evidence_of(ranges, signals, s);
      looks.right(e.z.size() == 4 && e.B.rows() == 4 && e.B.cols() == 8);
      // Parity: what no position and no clock can make.
      for (int row = 0; row < 4; ++row) {
        double common = 0.0, own = 0.0;
        Vector3d moved = Vector3d::Zero();
        for (int i = 0; i < 8; ++i) {
          const auto k = static_cast<std::size_t>(i);
          common += e.B(row, i);
          moved += e.B(row, i) * line_of_sight(ranges[k].p_E, s.p_E).line;
          own += e.B(row, i) * s.residuals_m[k];
        }
        looks.near(common, 0.0, 1e-13);
        looks.near(moved.norm(), 0.0, 1e-13);
        looks.near(e.z[row], own, 1e-13 * (1.0 + 100.0 * error_m));
      }
      const auto likelihood = [&](const std::vector<double>& sigma, double& squares) {
        Eigen::MatrixXd S = Eigen::MatrixXd::Zero(4, 4);
        for (int i = 0; i < 8; ++i)
          S += squared(sigma[static_cast<std::size_t>(i)]) * e.B.col(i) * e.B.col(i).transpose();
        squares = e.z.dot(S.inverse() * e.z);
        return -0.5 * (squares + std::log(S.determinant()));
      };
      std::vector<double> by[3];
      double squares = 0.0, log_of[3];
      for (int m = 0; m < 3; ++m) {
        for (std::size_t i = 0; i < 8; ++i) {
          const double noise = std::exp(-0.1 * cn0 * std::log(10.0));
          const double degraded =
              signals[i].code_factor * std::sqrt(m == 1 ? 10.0 + 22500.0 * noise : 500.0 + 1e6 * noise);
          by[m].push_back(m == 0 || degraded < ranges[i].sigma_m ? ranges[i].sigma_m : degraded);
        }
        log_of[m] = likelihood(by[m], squares);
        if (m == 0) {
          looks.near(log_likelihood(e, by[0]), log_of[0], 1e-9 * (1.0 + squares));
          const auto inflated = (*ModelChoice<reported_covariances>("residual_inflated").make("stress"))->sigma_m(e);
          const double factor = squares > 4.0 ? std::sqrt(squares / 4.0) : 1.0;
          for (std::size_t i = 0; i < 8; ++i) looks.near(inflated[i] / ranges[i].sigma_m, factor, 1e-9 * factor);
        }
      }
      const double top = worse(worse(log_of[0], log_of[1]), log_of[2]);
      if (cn0 == cn0) {
        const auto found = (*ModelChoice<reported_covariances>("environment").make("stress"))->sigma_m(e);
        double sum = 0.0;
        for (const double l : log_of) sum += std::exp(l - top);
        for (std::size_t i = 0; i < 8; ++i) {
          double variance = 0.0;
          for (int m = 0; m < 3; ++m) variance += std::exp(log_of[m] - top) / sum * squared(by[m][i]);
          looks.near(found[i], std::sqrt(variance), 1e-8 * (1.0 + squares) * found[i]);
        }
      }
      looks.near((covariance_of_fit(ranges, e.assumed_m, s) - s.covariance_E).norm(), 0.0,
                 1e-10 * s.covariance_E.norm());
      // The gain by differences: a range that is a metre longer.
      std::vector<double> ones(8, 1.0);
      const Eigen::MatrixXd gain = spread_of_fit(ranges, ones, s);
      double total = 0.0;
      for (int i = 0; i < 8; ++i) {
        auto longer = ranges;
        longer[static_cast<std::size_t>(i)].range_m += 1.0;
        const Vector3d by_1_m = make_least_squares({})->solve(longer, at_E).p_E - s.p_E;
        // Curvature of a range of 2.2e7 m: 1e-7 m; rounding of places in E.
        looks.near((by_1_m - gain.col(i)).norm(), 0.0, 1e-6);
        total += by_1_m.norm();
      }
      looks.near(s.range_gain, total, 1e-5);
    }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> accuracy_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "figures of a list of fixes",
           .why = "deviations about no mean, a percentile's rank off by one, epochs without a truth that count",
           .expected = "sums over the errors that were put in, to the rounding of places on Earth",
           .unit = "of the bound"});
  for (const int n : {1, 2, 7, 400})
    rows.add("accuracy/statistics_of_" + std::to_string(n), [n] { return statistics_of(n); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "what a receiver says its ranges are good for",
           .why = "a likelihood without its determinant, a variance in the place of a sigma",
           .expected = "the same from parity, likelihoods and differences: conditioning of four equations",
           .unit = "of the bound"});
  rows.add("accuracy/reported_sigmas", reported_sigmas);
  return rows.take();
}

}  // namespace canyon::gnss
