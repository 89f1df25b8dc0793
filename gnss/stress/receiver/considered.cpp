// The filter of position, velocity and time as a textbook writes it, with the errors of satellites among its states.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/solver/pvt_filter.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using stress::Looks;

constexpr Index kStates = 11, kClockAt = 6, kDriftAt = 7, kOthersAt = 8;
constexpr std::uint32_t kSatellites = 10;
const GpsTime kFirst = GpsTime::from_week_sow(2100, 200000.0);

double square(double x) {
  return x * x;
}

/// Sigmas as told, by satellite and with the evidence's number; and the evidence that was shown.
class ToldErrors final : public RangeErrorReport {
 public:
  explicit ToldErrors(double correlation_s) : correlation_s_(correlation_s) {}
  std::vector<double> sigma_m(const RangeEvidence& evidence) const override {
    shown = evidence;
    std::vector<double> out;
    for (const RangeSignal& s : evidence.signals) out.push_back(sigma_of(s.entity));
    return out;
  }
  double correlation_s() const override { return correlation_s_; }
  static double sigma_of(std::uint32_t entity) { return 2.0 + 0.7 * entity; }

  mutable RangeEvidence shown;

 private:
  double correlation_s_;
};

/// What a receiver that moves straight on measures of satellites of four systems.
struct Sky {
  std::vector<RangeMeasurement> ranges;
  std::vector<RateMeasurement> rates;
  std::vector<RangeSignal> signals;
  Vector3d truth_E;
};
Sky sky_at(double t_s, int epoch, const RandomStream& draws) {
  constexpr GnssSystem kSystems[] = {
      GnssSystem::kGps,  GnssSystem::kGps,     GnssSystem::kGalileo, GnssSystem::kGlonass, GnssSystem::kBeidou,
      GnssSystem::kQzss, GnssSystem::kGalileo, GnssSystem::kGlonass, GnssSystem::kGps,     GnssSystem::kBeidou};
  const double clocks_m[] = {0.0, 40.0, -25.0, 110.0};  // GPS, GLONASS, Galileo, BeiDou
  const Geodetic here{0.62, 0.3, 200.0};
  const Vector3d start_E = ecef_from_geodetic(here), v_E(7.0, -3.0, 5.0);
  const Eigen::Matrix3d R = rotation_E_from_enu(here);
  Sky out;
  out.truth_E = start_E + t_s * v_E;
  for (std::uint32_t k = 0; k < kSatellites; ++k) {
    if (k == 4 && epoch >= 4) continue;  // sets
    const double e = 0.2 + 0.12 * k, a = 2.4 * k + 1e-4 * t_s;
    RangeMeasurement r;
    r.p_E = start_E + 2.2e7 * (R * Vector3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)));
    r.system = kSystems[k];
    r.sigma_m = 1.0 + 0.3 * k;
    r.shared_m = epoch > 0 ? 0.5 : 0.0;
    const auto at = static_cast<std::uint64_t>(epoch);
    const double own_m = clocks_m[r.system == GnssSystem::kGlonass   ? 1
                                  : r.system == GnssSystem::kGalileo ? 2
                                  : r.system == GnssSystem::kBeidou  ? 3
                                                                     : 0];
    r.range_m = line_of_sight(r.p_E, out.truth_E).range_m + 500.0 + 9.0 * t_s + own_m +
                r.sigma_m * draws.normal(k, at) + (k == 6 && epoch == 2 ? 3000.0 : 0.0);
    RateMeasurement m{r.p_E, R * Vector3d(1500.0 - 300.0 * k, 900.0, -500.0), 0.0, 0.1 * r.sigma_m};
    m.rate_m_s = range_rate_m_s(m, out.truth_E, v_E) + 9.0 + m.sigma_m_s * draws.normal(50 + k, at);
    out.ranges.push_back(r), out.rates.push_back(m);
    out.signals.push_back({k, 40.0, 1.0});
  }
  return out;
}

/// States, then the error of each satellite in units of its sigma, which keeps its own variance of 1.
struct Textbook {
  PvtFilterParameters p{};
  double tau_s = 0.0;
  VectorXd x = VectorXd::Zero(kStates);
  MatrixXd P = MatrixXd::Zero(kStates, kStates);  ///< its own, by which it weighs
  MatrixXd W = MatrixXd::Zero(kStates + kSatellites, kStates + kSatellites);
  double last_seen_s[kSatellites] = {};
  double nis = 0.0;
  int used = 0;
  MatrixXd shown_H{};  ///< of the ranges
  VectorXd shown_z{};

  static std::optional<Index> other(GnssSystem s) {
    if (s == GnssSystem::kGlonass) return kOthersAt;
    if (s == GnssSystem::kGalileo) return kOthersAt + 1;
    if (s == GnssSystem::kBeidou) return kOthersAt + 2;
    return std::nullopt;
  }
  auto reported() const { return W.topLeftCorner(kStates, kStates); }

  /// Least squares, whose gain carries each satellite's error into the position.
  void begin(const Sky& sky, bool with_rates, double t_s) {
    const PositionSolution s = make_least_squares(p.start)->solve(sky.ranges, sky.truth_E);
    x.setZero(), P.setZero(), W.setZero();
    x.head<3>() = s.p_E, x[kClockAt] = s.clock_m;
    P.topLeftCorner<3, 3>() = s.covariance_E;
    P(kClockAt, kClockAt) = 1e6;
    P.block<3, 3>(3, 3) = square(p.unknown_speed_m_s) * Eigen::Matrix3d::Identity();
    P(kDriftAt, kDriftAt) = 1e6;
    if (with_rates) {
      const VelocitySolution v = solve_velocity(sky.rates, s.p_E, {p.start.max_gdop, 5.0});
      x.segment<3>(3) = v.v_E, x[kDriftAt] = v.clock_drift_m_s;
      P.block<3, 3>(3, 3) = v.covariance_E;
      P(kDriftAt, kDriftAt) = 100.0;
    }
    for (const RangeMeasurement& r : sky.ranges)
      if (const auto at = other(r.system))
        x[*at] = s.system_clock_m[static_cast<std::size_t>(r.system)] - s.clock_m, P(*at, *at) = 1e6;
    W.topLeftCorner(kStates, kStates) = P;
    std::vector<double> sigma;
    for (const RangeSignal& signal : sky.signals) sigma.push_back(ToldErrors::sigma_of(signal.entity));
    const MatrixXd spread = spread_of_fit(sky.ranges, sigma, s);
    W.topLeftCorner<3, 3>() = spread * spread.transpose();
    W.bottomRightCorner(kSatellites, kSatellites).setIdentity();
    for (std::size_t i = 0; i < sky.signals.size(); ++i) {
      const Index b = kStates + static_cast<Index>(sky.signals[i].entity);
      if (tau_s > 0.0) W.block(0, b, 3, 1) = spread.col(static_cast<Index>(i));
      W.block(b, 0, 1, 3) = W.block(0, b, 3, 1).transpose();
      last_seen_s[sky.signals[i].entity] = t_s;
    }
  }

  void predict(double dt, double t_s) {
    MatrixXd F = MatrixXd::Identity(kStates + kSatellites, kStates + kSatellites);
    for (Index i = 0; i < 3; ++i) F(i, 3 + i) = dt;
    F(kClockAt, kDriftAt) = dt;
    // White acceleration and, of the clock, white frequency and its random walk: Brown & Hwang's integrals.
    MatrixXd Q = MatrixXd::Zero(kStates, kStates);
    const double a2 = square(p.acceleration_m_s2), f2 = square(p.clock_m), g2 = square(p.drift_m_s);
    for (Index i = 0; i < 3; ++i) {
      Q(i, i) = a2 * dt * dt * dt / 3.0, Q(3 + i, 3 + i) = a2 * dt;
      Q(i, 3 + i) = Q(3 + i, i) = a2 * dt * dt / 2.0;
    }
    Q(kClockAt, kClockAt) = f2 * dt + g2 * dt * dt * dt / 3.0, Q(kDriftAt, kDriftAt) = g2 * dt;
    Q(kClockAt, kDriftAt) = Q(kDriftAt, kClockAt) = g2 * dt * dt / 2.0;
    for (Index i = kOthersAt; i < kStates; ++i) Q(i, i) = square(p.inter_system_m) * dt;
    const MatrixXd own = F.topLeftCorner(kStates, kStates);
    x = own * x;
    P = own * P * own.transpose() + Q;
    for (std::uint32_t k = 0; k < kSatellites; ++k) {
      const Index b = kStates + static_cast<Index>(k);
      F(b, b) = tau_s > 0.0 && t_s - dt - last_seen_s[k] <= 20.0 * tau_s ? std::exp(-dt / tau_s) : 0.0;
    }
    W = F * W * F.transpose();
    W.topLeftCorner(kStates, kStates) += Q;
    W.bottomRightCorner(kSatellites, kSatellites).setIdentity();
  }

  void rows(const Sky& sky, MatrixXd& H, VectorXd& z, VectorXd& variance) const {
    const auto n = static_cast<Index>(sky.ranges.size()), m = static_cast<Index>(sky.rates.size());
    H = MatrixXd::Zero(n + m, kStates), z = VectorXd::Zero(n + m), variance = VectorXd::Zero(n + m);
    for (Index i = 0; i < n + m; ++i) {
      const bool range = i < n;
      const auto k = static_cast<std::size_t>(range ? i : i - n);
      const LineOfSight sight = line_of_sight(range ? sky.ranges[k].p_E : sky.rates[k].p_E, x.head<3>());
      H.block<1, 3>(i, range ? 0 : 3) = -sight.line.transpose();
      H(i, range ? kClockAt : kDriftAt) = 1.0;
      if (!range) {
        z[i] = sky.rates[k].rate_m_s - range_rate_m_s(sky.rates[k], x.head<3>(), x.segment<3>(3)) - x[kDriftAt];
        variance[i] = square(sky.rates[k].sigma_m_s);
        continue;
      }
      double expected = sight.range_m + x[kClockAt];
      if (const auto at = other(sky.ranges[k].system)) H(i, *at) = 1.0, expected += x[*at];
      z[i] = sky.ranges[k].range_m - expected;
      variance[i] = square(sky.ranges[k].sigma_m) + square(sky.ranges[k].shared_m);
    }
  }

  std::vector<Index> inside(const MatrixXd& H, const VectorXd& z, const VectorXd& variance) const {
    const double gate = chi_square_threshold(p.gate_probability, 1);
    std::vector<Index> out;
    for (Index i = 0; i < z.size(); ++i)
      if (square(z[i]) <= gate * (H.row(i).dot(P * H.row(i).transpose()) + variance[i])) out.push_back(i);
    return out;
  }

  std::vector<bool> update(const Sky& sky, double t_s) {
    MatrixXd all;
    VectorXd z, variance;
    rows(sky, all, z, variance);
    const auto n = static_cast<Index>(sky.ranges.size());
    std::vector<Index> good = inside(all, z, variance);
    if (2 * std::count_if(good.begin(), good.end(), [n](Index i) { return i < n; }) < n) {
      std::vector<double> sorted(z.data(), z.data() + n);
      std::sort(sorted.begin(), sorted.end());
      x[kClockAt] += sorted[sorted.size() / 2];
      P.row(kClockAt).setZero(), P.col(kClockAt).setZero(), P(kClockAt, kClockAt) = 100.0;
      W.row(kClockAt).setZero(), W.col(kClockAt).setZero(), W(kClockAt, kClockAt) = 100.0;
      rows(sky, all, z, variance);
      good = inside(all, z, variance);
    }
    shown_H = all.topRows(n), shown_z = z.head(n);
    const auto count = static_cast<Index>(good.size());
    MatrixXd H = all(good, Eigen::all), A = MatrixXd::Zero(count, kStates + kSatellites);
    VectorXd noise = variance(good);
    const MatrixXd R = noise.asDiagonal();
    const MatrixXd S = H * P * H.transpose() + R, K = P * H.transpose() * S.inverse();
    const VectorXd taken = z(good);
    nis = taken.dot(S.inverse() * taken), used = static_cast<int>(count);
    // As the errors are told: a satellite's own, times its sigma, and white noise of the Dopplers.
    double inflation = 0.0;
    for (Index i = 0; i < n; ++i)
      inflation += square(ToldErrors::sigma_of(sky.signals[static_cast<std::size_t>(i)].entity)) / variance[i] /
                   static_cast<double>(n);
    MatrixXd white = MatrixXd::Zero(count, count);
    A.leftCols(kStates) = H;
    std::vector<bool> ranges_used(sky.ranges.size(), false);
    for (Index i = 0; i < count; ++i) {
      const Index k = good[static_cast<std::size_t>(i)];
      if (k >= n) {
        white(i, i) = (inflation > 1.0 ? inflation : 1.0) * variance[k];
        continue;
      }
      const std::uint32_t entity = sky.signals[static_cast<std::size_t>(k)].entity;
      ranges_used[static_cast<std::size_t>(k)] = true;
      last_seen_s[entity] = t_s;
      const double sigma = ToldErrors::sigma_of(entity);
      if (tau_s > 0.0)
        A(i, kStates + static_cast<Index>(entity)) = -sigma;  // e - K (H e - v) with v = sigma times its error
      else
        white(i, i) = square(sigma);
    }
    MatrixXd wide = MatrixXd::Zero(kStates + kSatellites, count);
    wide.topRows(kStates) = K;
    const MatrixXd step = MatrixXd::Identity(kStates + kSatellites, kStates + kSatellites) - wide * A;
    W = step * W * step.transpose() + wide * white * wide.transpose();
    x += K * taken;
    const MatrixXd rest = MatrixXd::Identity(kStates, kStates) - K * H;
    P = rest * P * rest.transpose() + K * R * K.transpose();
    return ranges_used;
  }
};

/// Places in E round by 1e-9 m; variances of 1 and 1e6 m^2 stand beside one another, so that a gain is good to 1e6 eps,
/// 1e-9, of innovations of up to 100 m: 1e-6 m, and 1e-7 of a variance.
StressFigure by_the_book(double tau_s, bool rates_at_first, double jump_m, bool told) {
  Looks looks;
  const RandomStream draws(21, "stress.considered");
  PvtFilterParameters p;
  p.acceleration_m_s2 = 0.8, p.clock_m = 0.4, p.drift_m_s = 0.07, p.inter_system_m = 0.02;
  PvtFilter filter(p);
  Textbook book;
  book.p = p, book.tau_s = tau_s;
  const ToldErrors errors(tau_s);
  double t_s = 0.0;
  for (int epoch = 0; epoch < 9; ++epoch) {
    const double dt = epoch == 0 ? 0.0 : epoch == 6 ? 25.0 : 0.5 + 0.25 * epoch;
    t_s += dt;
    Sky sky = sky_at(t_s, epoch, draws);
    if (epoch == 0 && !rates_at_first) sky.rates.clear();
    if (epoch >= 5)
      for (RangeMeasurement& r : sky.ranges) r.range_m += jump_m;
    const PvtFilter::Report report{errors, sky.signals};
    if (epoch > 0) {
      const auto expected_E = filter.predicted_p_E(kFirst + t_s);
      book.predict(dt, t_s);
      looks.near((*expected_E - book.x.head<3>()).norm(), 0.0, 1e-6);
    }
    const auto found = filter.update(kFirst + t_s, sky.ranges, sky.rates, sky.truth_E, told ? &report : nullptr);
    const MatrixXd before = book.reported();
    if (epoch == 0) {
      book.begin(sky, rates_at_first, t_s);
      looks.right(found.begun_anew && found.ok);
    } else {
      const std::vector<bool> used = book.update(sky, t_s);
      looks.right(found.ok && !found.begun_anew && found.ranges_used == used && found.nis_degrees == book.used);
      looks.right((epoch == 2) == (std::count(used.begin(), used.end(), false) > 0));
      looks.near(found.nis / book.nis, 1.0, 1e-6);
    }
    const MatrixXd& P = told ? MatrixXd(book.reported()) : book.P;
    looks.near((found.p_E - book.x.head<3>()).norm(), 0.0, 1e-6);
    looks.near((found.v_E - book.x.segment<3>(3)).norm(), 0.0, 1e-6);
    looks.near(found.clock_m, book.x[kClockAt], 1e-6);
    looks.near(found.drift_m_s, book.x[kDriftAt], 1e-6);
    for (Index i = 0; i < 6; ++i)
      for (Index j = 0; j < 6; ++j) looks.near(found.covariance(i, j), P(i, j), 1e-7 * std::sqrt(P(i, i) * P(j, j)));
    GnssFix fix;
    found.fill(fix);
    looks.right(fix.p_A_E == found.p_E && fix.v_A_E == found.v_E && fix.clock_m == found.clock_m);
    looks.right(fix.covariance_E(0, 2) == found.covariance(0, 2) &&
                fix.velocity_covariance_E(1, 2) == found.covariance(4, 5));
    if (epoch == 0 || !told) continue;
    const RangeEvidence& e = errors.shown;
    const auto n = static_cast<Index>(sky.ranges.size());
    looks.right(e.z.size() == n && e.B == MatrixXd::Identity(n, n) && e.signals.size() == sky.signals.size());
    const MatrixXd shown = book.shown_H * before * book.shown_H.transpose();
    const bool jumped = jump_m != 0.0 && epoch == 5;  // `before` does not know of it
    for (Index i = 0; i < n; ++i) {
      looks.near(e.z[i], book.shown_z[i], 1e-6);
      if (!jumped) looks.near(e.predicted(i, (i + 2) % n), shown(i, (i + 2) % n), 1e-7 * shown.trace());
      const RangeMeasurement& r = sky.ranges[static_cast<std::size_t>(i)];
      looks.close(e.assumed_m[static_cast<std::size_t>(i)], std::hypot(r.sigma_m, r.shared_m), 4.0);
    }
  }
  // Of something that is not good nothing is filled in.
  GnssFix untouched;
  PvtFilter::Estimate none;
  none.p_E = Vector3d::Ones();
  none.fill(untouched);
  looks.right(std::isnan(untouched.p_A_E.x()) && std::isnan(untouched.clock_m));
  looks.right(!PvtFilter(p).predicted_p_E(kFirst).has_value());
  return looks.figure();
}

/// Carried off by 100 km it begins anew; with less than four ranges it does not; and of a speed that nothing tells
/// it knows no more than its 30 m/s.
StressFigure carried_off() {
  Looks looks;
  const RandomStream draws(22, "stress.considered");
  // Of one system, whose clock it knows, and without errors.
  const auto ranges_from = [&](const Vector3d& at_E) {
    std::vector<RangeMeasurement> out = sky_at(0.0, 0, draws).ranges;
    for (RangeMeasurement& r : out) r.system = GnssSystem::kGps, r.range_m = line_of_sight(r.p_E, at_E).range_m + 500.0;
    return out;
  };
  const Vector3d here_E = sky_at(0.0, 0, draws).truth_E, there_E = here_E + Vector3d(9e4, -8e4, 7e4);
  PvtFilter filter{{}};
  const auto begun = filter.update(kFirst, ranges_from(here_E), {}, here_E);
  for (int i = 3; i < 6; ++i)
    for (int j = 3; j < 6; ++j) looks.right(begun.covariance(i, j) == (i == j ? 900.0 : 0.0));
  looks.right(begun.v_E == Vector3d::Zero() && begun.drift_m_s == 0.0);
  PvtFilter other = filter;
  const auto away = ranges_from(there_E);
  const auto anew = filter.update(kFirst + 1.0, away, {}, here_E);
  looks.right(anew.ok && anew.begun_anew);
  looks.near((anew.p_E - there_E).norm(), 0.0, 16.0 * stress::kEpsilon * 2.2e7 * 4.0);  // GDOP 4
  const std::vector<RangeMeasurement> three(away.begin(), away.begin() + 3);
  const auto kept = other.update(kFirst + 1.0, three, {}, here_E);
  looks.right(kept.ok && !kept.begun_anew);
  return looks.figure();
}

/// What its keys are where nobody says otherwise: the densities of its own description.
StressFigure as_it_comes() {
  const PvtFilterParameters p;
  const bool same = p.acceleration_m_s2 == 1.0 && p.clock_m == 0.3 && p.drift_m_s == 0.05 &&
                    p.inter_system_m == 0.003 && p.gate_probability == 1e-4 && p.longest_gap_s == 120.0 &&
                    p.unknown_speed_m_s == 30.0;
  return {same ? 0.0 : 1.0, 0.0};
}

}  // namespace

std::vector<StressCase> considered_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "a filter's estimate and both of its covariances",
           .why = "a cross term left out or twice, an error that lasts too long, a clock's noise in the drift's place",
           .expected = "a filter with the satellites' errors among its states, written out: 1e6 eps of a gain",
           .unit = "of the bound",
           .loose = "the gain rounds less than its condition allows"});
  rows.add("considered/lasting_10_s", [] { return by_the_book(10.0, true, 0.0, true); })
      .add("considered/lasting_0.5_s", [] { return by_the_book(0.5, true, 0.0, true); })
      .add("considered/white_errors", [] { return by_the_book(0.0, true, 0.0, true); })
      .add("considered/without_a_first_speed", [] { return by_the_book(3.0, false, 0.0, true); })
      .add("considered/clock_that_jumps", [] { return by_the_book(5.0, true, 299792.458, true); })
      .add("considered/own_covariance", [] { return by_the_book(5.0, true, -1e5, false); });
  rows.of({StressGroup::kData, "a filter that is carried off", "too few ranges that begin it anew, an old place kept",
           "anew by four ranges, kept by three; nothing known of a speed", "of the bound"});
  rows.add("considered/carried_off", carried_off);
  rows.of({StressGroup::kData, "a filter as it comes", "a density of the wrong power of ten", "as described: exact",
           "differences"});
  rows.add("considered/as_it_comes", as_it_comes);
  return rows.take();
}

}  // namespace canyon::gnss
