#include "canyon/gnss/solver/pvt_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/solver/receiver_clocks.h"

namespace canyon::gnss {
namespace {

constexpr double kMedianM = 10.0;
constexpr double kForgottenTaus = 20.0;  // an error not seen for so long has nothing left in common with the state
constexpr double kUnknownClockM = 1e3;   // of a system's clock against GPS before it is seen: microseconds

/// Which of the three differences a system's clock has; none for GPS and what shares its clock.
std::optional<int> between(GnssSystem system) {
  switch (clock_system(system)) {
    case GnssSystem::kGlonass:
      return 0;
    case GnssSystem::kGalileo:
      return 1;
    case GnssSystem::kBeidou:
      return 2;
    default:
      return std::nullopt;
  }
}

}  // namespace

/// Rows of all measurements at the predicted state; the ranges first.
struct PvtFilter::Innovations {
  Eigen::MatrixXd H;
  Eigen::VectorXd value, variance;

  /// Those inside the gate, by their own predicted variance.
  std::vector<Eigen::Index> inside(const Covariance& P, double gate) const {
    std::vector<Eigen::Index> out;
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      const double s = H.row(i) * P * H.row(i).transpose() + variance[i];
      if (std::isfinite(s) && value[i] * value[i] <= gate * s) out.push_back(i);
    }
    return out;
  }
};

void PvtFilter::predict(double dt_s, const Report* report) {
  Covariance F = Covariance::Identity(), Q = Covariance::Zero();
  const auto integrate = [&](int position, int rate, double position_q, double rate_q) {
    F(position, rate) = dt_s;
    Q(position, position) = position_q * dt_s + rate_q * dt_s * dt_s * dt_s / 3.0;
    Q(position, rate) = Q(rate, position) = rate_q * dt_s * dt_s / 2.0;
    Q(rate, rate) = rate_q * dt_s;
  };
  const auto squared = [](double x) { return x * x; };
  for (int i = 0; i < 3; ++i) integrate(kP + i, kV + i, 0.0, squared(p_.acceleration_m_s2));
  integrate(kClock, kDrift, squared(p_.clock_m), squared(p_.drift_m_s));
  for (int i = kBetween; i < kSize; ++i) Q(i, i) = squared(p_.inter_system_m) * dt_s;
  x_ = F * x_;
  P_ = F * P_ * F.transpose() + Q;
  if (report == nullptr) return;
  reported_.P = F * reported_.P * F.transpose() + Q;
  const double tau_s = report->errors.correlation_s(), kept = tau_s > 0.0 ? std::exp(-dt_s / tau_s) : 0.0;
  for (auto with = reported_.with.begin(); with != reported_.with.end();) {
    with->second.c = kept * (F * with->second.c);
    const bool forgotten = t_ - with->second.t > kForgottenTaus * tau_s;
    with = forgotten ? reported_.with.erase(with) : std::next(with);
  }
}

PvtFilter::Innovations PvtFilter::innovations(std::span<const RangeMeasurement> ranges,
                                              std::span<const RateMeasurement> rates) const {
  const auto n = static_cast<Eigen::Index>(ranges.size()), m = static_cast<Eigen::Index>(rates.size());
  Innovations out{Eigen::MatrixXd::Zero(n + m, kSize), Eigen::VectorXd(n + m), Eigen::VectorXd(n + m)};
  const Eigen::Vector3d p_E = x_.segment<3>(kP), v_E = x_.segment<3>(kV);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& r = ranges[static_cast<std::size_t>(i)];
    const LineOfSight sight = line_of_sight(r.p_E, p_E);
    out.H.block<1, 3>(i, kP) = -sight.line.transpose();
    out.H(i, kClock) = 1.0;
    double predicted_m = sight.range_m + x_[kClock];
    if (const auto b = between(r.system)) {
      out.H(i, kBetween + *b) = 1.0;
      predicted_m += x_[kBetween + *b];
    }
    out.value[i] = r.range_m - predicted_m;
    // A filter has no unknown for what the ranges share; as independent noise it is at least not ignored.
    out.variance[i] = r.sigma_m * r.sigma_m + r.shared_m * r.shared_m;
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto& r = rates[static_cast<std::size_t>(i)];
    out.H.block<1, 3>(n + i, kV) = -line_of_sight(r.p_E, p_E).line.transpose();
    out.H(n + i, kDrift) = 1.0;
    out.value[n + i] = r.rate_m_s - range_rate_m_s(r, p_E, v_E) - x_[kDrift];
    out.variance[n + i] = r.sigma_m_s * r.sigma_m_s;
  }
  return out;
}

bool PvtFilter::begin(GpsTime t, std::span<const RangeMeasurement> ranges, std::span<const RateMeasurement> rates,
                      const Eigen::Vector3d& guess_E, Estimate& out, const Report* report) {
  const PositionSolution position = make_least_squares(p_.start)->solve(ranges, guess_E);
  out.reason = position.reason;
  if (!position.ok) return false;
  const VelocitySolution velocity = solve_velocity(rates, position.p_E, {p_.start.max_gdop, 5.0});
  const auto squared = [](double x) { return x * x; };
  t_ = t;
  running_ = true;
  out.begun_anew = true;
  x_.setZero();
  P_.setZero();
  x_.segment<3>(kP) = position.p_E;
  P_.block<3, 3>(kP, kP) = position.covariance_E;
  x_[kClock] = position.clock_m;
  P_(kClock, kClock) = squared(kUnknownClockM);
  P_.block<3, 3>(kV, kV).diagonal().setConstant(squared(p_.unknown_speed_m_s));
  P_(kDrift, kDrift) = squared(1e3);
  if (velocity.ok) {
    x_.segment<3>(kV) = velocity.v_E;
    P_.block<3, 3>(kV, kV) = velocity.covariance_E;
    x_[kDrift] = velocity.clock_drift_m_s;
    P_(kDrift, kDrift) = squared(10.0);
  }
  for (const GnssSystem s : {GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou}) {
    const double clock_m = position.system_clock_m[static_cast<std::size_t>(s)];
    const int i = kBetween + *between(s);
    x_[i] = std::isfinite(clock_m) ? clock_m - position.clock_m : 0.0;
    P_(i, i) = squared(kUnknownClockM);
  }
  out.ranges_used = position.used;
  if (report != nullptr) {
    const std::vector<double> sigma_m = report->errors.sigma_m(evidence_of(ranges, report->signals, position));
    reported_ = {};
    reported_.P = P_;
    const Eigen::MatrixXd spread_m = spread_of_fit(ranges, sigma_m, position);
    reported_.P.block<3, 3>(kP, kP) = spread_m * spread_m.transpose();
    for (std::size_t i = 0; i < ranges.size() && report->errors.correlation_s() > 0.0; ++i) {
      Consider::With& with = reported_.with[report->signals[i].entity];
      with = {State::Zero(), t};
      with.c.segment<3>(kP) = spread_m.col(static_cast<Eigen::Index>(i));
    }
  }
  return true;
}

/// By the innovations of all ranges, also of those outside the gate: they too tell where the receiver is.
std::vector<double> PvtFilter::reported_sigmas(const Innovations& all, std::span<const RangeMeasurement> ranges,
                                               const Report& report) const {
  const auto n = static_cast<Eigen::Index>(ranges.size());
  RangeEvidence evidence;
  const Eigen::MatrixXd H = all.H.topRows(n);
  evidence.z = all.value.head(n);
  evidence.B = Eigen::MatrixXd::Identity(n, n);
  evidence.predicted = H * reported_.P * H.transpose();
  for (Eigen::Index i = 0; i < n; ++i) evidence.assumed_m.push_back(std::sqrt(all.variance[i]));
  evidence.signals.assign(report.signals.begin(), report.signals.end());
  return report.errors.sigma_m(evidence);
}

/// The second covariance after an update with these gains. e+ = (I - K H) e + K v; v of a range is its sigma times an
/// error that lasts, of a rate white noise as much larger than assumed as the ranges' are.
void PvtFilter::consider(const Innovations& all, const std::vector<Eigen::Index>& used, const Eigen::MatrixXd& H,
                         const Eigen::MatrixXd& K, const std::vector<double>& sigma_m, const Report& report) {
  const auto n = static_cast<Eigen::Index>(used.size()), ranges = static_cast<Eigen::Index>(sigma_m.size());
  double inflation = 0.0;
  for (Eigen::Index i = 0; i < ranges; ++i)
    inflation += sigma_m[static_cast<std::size_t>(i)] * sigma_m[static_cast<std::size_t>(i)] / all.variance[i] /
                 static_cast<double>(ranges);
  const Covariance I_KH = Covariance::Identity() - K * H;
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(n, n), C = Eigen::MatrixXd::Zero(kSize, n);  // C: of e with v
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index k = used[static_cast<std::size_t>(i)];
    if (k >= ranges) {
      R(i, i) = std::max(1.0, inflation) * all.variance[k];
      continue;
    }
    const double s = sigma_m[static_cast<std::size_t>(k)];
    R(i, i) = s * s;
    const auto with = reported_.with.find(report.signals[static_cast<std::size_t>(k)].entity);
    if (with != reported_.with.end()) C.col(i) = s * with->second.c;
  }
  const Covariance cross = I_KH * C * K.transpose();
  reported_.P = I_KH * reported_.P * I_KH.transpose() + K * R * K.transpose() + cross + cross.transpose();
  for (auto& [entity, with] : reported_.with) with.c = I_KH * with.c;
  if (report.errors.correlation_s() <= 0.0) return;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(used[static_cast<std::size_t>(i)]);
    if (static_cast<Eigen::Index>(k) >= ranges) continue;
    const auto [with, fresh] = reported_.with.try_emplace(report.signals[k].entity, Consider::With{State::Zero(), t_});
    with->second.c += sigma_m[k] * K.col(i);
    with->second.t = t_;
  }
}

/// Receivers that steer their clock in steps, often of a millisecond, shift all ranges at once.
bool PvtFilter::take_clock_jump(std::span<const RangeMeasurement> ranges) {
  const Innovations now = innovations(ranges, {});
  std::vector<double> values(now.value.data(), now.value.data() + now.value.size());
  if (values.size() < 3) return false;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  const double median_m = values[values.size() / 2];
  x_[kClock] += median_m;
  P_.row(kClock).setZero();
  P_.col(kClock).setZero();
  // The median of ranges is good to metres; a wider variance would let faults through the gate now.
  P_(kClock, kClock) = kMedianM * kMedianM;
  reported_.P.row(kClock).setZero();
  reported_.P.col(kClock).setZero();
  reported_.P(kClock, kClock) = kMedianM * kMedianM;
  for (auto& [entity, with] : reported_.with) with.c[kClock] = 0.0;
  return true;
}

void PvtFilter::describe(Estimate& out, const Report* report) const {
  out.ok = true;
  out.reason.clear();
  out.p_E = x_.segment<3>(kP);
  out.v_E = x_.segment<3>(kV);
  out.clock_m = x_[kClock];
  out.drift_m_s = x_[kDrift];
  out.covariance = (report == nullptr ? P_ : reported_.P).topLeftCorner<6, 6>();
}

void PvtFilter::Estimate::fill(GnssFix& fix) const {
  if (!ok) return;
  fix.p_A_E = p_E;
  fix.v_A_E = v_E;
  fix.clock_m = clock_m;
  fix.covariance_E = covariance.topLeftCorner<3, 3>();
  fix.velocity_covariance_E = covariance.bottomRightCorner<3, 3>();
}

PvtFilter::Estimate PvtFilter::update(GpsTime t, std::span<const RangeMeasurement> ranges,
                                      std::span<const RateMeasurement> rates, const Eigen::Vector3d& guess_E,
                                      const Report* report) {
  if (report != nullptr && report->errors.as_assumed()) report = nullptr;
  Estimate out;
  out.ranges_used.assign(ranges.size(), false);
  if (running_ && (t <= t_ || t - t_ > p_.longest_gap_s)) running_ = false;
  if (!running_) {
    if (begin(t, ranges, rates, guess_E, out, report)) describe(out, report);
    return out;
  }
  predict(t - t_, report);
  t_ = t;

  const double gate = chi_square_threshold(p_.gate_probability, 1);
  Innovations now = innovations(ranges, rates);
  std::vector<Eigen::Index> inside = now.inside(P_, gate);
  const auto good_ranges = [&] {
    return static_cast<std::size_t>(std::count_if(
        inside.begin(), inside.end(), [&](Eigen::Index i) { return i < static_cast<Eigen::Index>(ranges.size()); }));
  };
  if (2 * good_ranges() < ranges.size() && take_clock_jump(ranges)) {
    now = innovations(ranges, rates);
    inside = now.inside(P_, gate);
  }
  if (2 * good_ranges() < ranges.size() && ranges.size() >= 4) {
    // Neither position nor clock explains what is measured: it is not where it thinks.
    const Eigen::Vector3d here_E = x_.segment<3>(kP);
    running_ = false;
    if (begin(t, ranges, rates, here_E, out, report)) describe(out, report);
    return out;
  }

  const auto n = static_cast<Eigen::Index>(inside.size());
  if (n > 0) {
    Eigen::MatrixXd H(n, kSize), R = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd nu(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index k = inside[static_cast<std::size_t>(i)];
      H.row(i) = now.H.row(k);
      R(i, i) = now.variance[k];
      nu[i] = now.value[k];
      if (k < static_cast<Eigen::Index>(ranges.size())) out.ranges_used[static_cast<std::size_t>(k)] = true;
    }
    const Eigen::MatrixXd S = H * P_ * H.transpose() + R;
    const Eigen::LDLT<Eigen::MatrixXd> factor(S);
    const Eigen::MatrixXd K = factor.solve(H * P_).transpose();
    out.nis = nu.dot(factor.solve(nu));
    out.nis_degrees = static_cast<int>(n);
    x_ += K * nu;
    // Joseph's form keeps it symmetric and positive.
    const Covariance I_KH = Covariance::Identity() - K * H;
    P_ = I_KH * P_ * I_KH.transpose() + K * R * K.transpose();
    if (report != nullptr) consider(now, inside, H, K, reported_sigmas(now, ranges, *report), *report);
  }
  describe(out, report);
  return out;
}

std::optional<Eigen::Vector3d> PvtFilter::predicted_p_E(GpsTime t) const {
  if (!running_) return std::nullopt;
  return Eigen::Vector3d(x_.segment<3>(kP) + (t - t_) * x_.segment<3>(kV));
}

ModelTable<Estimator> estimators() {
  static constexpr ModelRow<Estimator> kRows[] = {
      {"least_squares", Estimator::kLeastSquares, "each epoch by itself"},
      {"kalman", Estimator::kKalman, "position, velocity and time filtered"},
  };
  return kRows;
}

}  // namespace canyon::gnss
