// What a run says of a filter: series of normal numbers, and what is made of them.
#include <vector>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/fusion/rounding_growth.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/fusion/stress/subjects.h"
#include "canyon/fusion/verdict/verdict.h"

namespace canyon::fusion {
namespace {

using stress::kEpsilon;
using stress::Worst;

GpsTime at(int k) {
  return GpsTime::from_week_sow(1590, 396000.0) + 0.5 * k;
}

/// x' = kept x + noise, of unit variance and two elements.
NormalSeries markov(double kept, int count, std::uint64_t seed) {
  const RandomStream stream(seed, "stress.markov");
  NormalSeries out(2);
  Eigen::Vector2d x(stream.normal(0, 0), stream.normal(1, 0));
  for (int k = 0; k < count; ++k) {
    const auto n = static_cast<std::uint64_t>(k) + 1;
    x = kept * x + std::sqrt(1.0 - kept * kept) * Eigen::Vector2d(stream.normal(0, n), stream.normal(1, n));
    out.add(at(k), x);
  }
  return out;
}

/// A Markov process of N vectors: mean square 1 and lags kept^k, off by 5 sigma (false alarm 6e-7 each), sigma being 1
/// / root of what they are worth, n N (1 - kept^2) / (1 + kept^2) numbers, doubled by the mean square that lags are
/// divided by; what they are worth by the same of its sum of squares, 1 / e after -dt / ln(kept), where lags lie up to
/// a sixteenth of it apart.
StressFigure series(double kept) {
  constexpr int kCount = 40'000;
  const NormalSeries found = markov(kept, kCount, 3);
  const double worth = kCount * (1.0 - kept * kept) / (1.0 + kept * kept), off = 5.0 * std::sqrt(2.0 / (2.0 * worth));
  Worst worst;
  worst.look(found.mean_square() - 1.0, off);
  worst.look(found.interval_s() - 0.5, 1e-9);
  const auto lags = found.lags();
  for (std::size_t k = 0; k < 16; ++k) worst.look(lags[k].r - std::pow(kept, lags[k].samples), 2.0 * off);
  if (kept > 0.0) {
    worst.look(found.effective_samples() / worth - 1.0, 4.0 * off);
    worst.look(found.correlation_s() * -std::log(kept) / 0.5 - 1.0, 4.0 * off + 1.0 / 16.0);
  } else {
    const auto [statistic, degrees] = found.portmanteau();
    worst.look(degrees == 16 ? 0.0 : stress::kInfinity, 1.0);
    worst.look(std::max(statistic, 1.0), chi_square_threshold(1e-6, 16.0));
    worst.look(found.effective_samples() / kCount - 1.0, 32.0 / kCount * 4.0 + 1e-3);
  }
  return worst.figure();
}

/// Errors drawn from a covariance of three axes that hang together: each share within its ellipsoid, each axis and the
/// whole of mean square 1 over their claimed one: 5 sigma of binomial and chi-square; and with sigma claimed a third
/// the mean square is 9, of which that of an axis is found off.
StressFigure coverage(double claimed) {
  constexpr int kCount = 20'000;
  const RandomStream stream(7, "stress.errors");
  Eigen::Matrix3d L;
  L << 2.0, 0.0, 0.0, 1.5, 0.3, 0.0, -0.7, 0.2, 0.1;
  const Eigen::Matrix3d P = claimed * claimed * L * L.transpose();
  ErrorRecord record(ErrorRecord::navigation());
  for (int k = 0; k < kCount; ++k)
    record.add(ErrorRecord::kVelocity, at(k), L * stream.normal3(static_cast<std::uint64_t>(k)), P);
  const BlockErrors& block = record.blocks()[ErrorRecord::kVelocity];
  Worst worst;
  const double five = 5.0 * std::sqrt(2.0 / kCount);
  worst.look(block.series.mean_square() * claimed * claimed - 1.0, five);
  for (const AxisErrors& axis : block.axes) {
    worst.look(axis.series.mean_square() * claimed * claimed - 1.0, five);
    worst.look(axis.error_squares / axis.variances * claimed * claimed - 1.0, five);
  }
  for (std::size_t i = 0; i < 3 && claimed == 1.0; ++i) {
    const double share = BlockErrors::kShares[i];
    worst.look(block.coverage(i) - share, 5.0 * std::sqrt(share * (1.0 - share) / kCount));
  }
  const VerdictNumbers numbers = verdict_numbers({.errors = &record});
  worst.look(numbers.tests == 4 && numbers.axes.size() == 3 ? 0.0 : stress::kInfinity, 1.0);
  const bool off = numbers.axes[0].ratio.off() && numbers.blocks[0].nees.off();
  worst.look(off == (claimed != 1.0) ? 0.0 : stress::kInfinity, 1.0);
  worst.look(findings(numbers).empty() == (claimed == 1.0) ? 0.0 : stress::kInfinity, 1.0);
  return worst.figure();
}

/// Innovations of one row, three at an instant or one: mean NIS per dimension, its median over that of chi-square, to
/// the 2 % that the bins have, and as many as were refused. 5 sigma: of a median sqrt(pi / 2) times the mean's.
StressFigure innovations(int parts) {
  constexpr int kCount = 30'000;
  const RandomStream stream(9, "stress.innovations");
  InnovationRecord record;
  for (int k = 0; k < kCount; ++k) {
    UpdateReport report{.measurement = "position", .t = at(k / parts), .accepted = k % 10 != 0, .dimension = 2};
    const auto n = static_cast<std::uint64_t>(k);
    report.normalized.head<2>() << stream.normal(0, n), stream.normal(1, n);
    report.nis = report.normalized.squaredNorm();
    record.add(report);
  }
  const InnovationRow row = record.rows().at("position");
  Worst worst;
  worst.look(row.nis_per_dimension() - 1.0, 5.0 / std::sqrt(kCount));
  // Chi-square of two is exponential: the density at its median ln 4 is a quarter.
  worst.look(row.nis_median_ratio() - 1.0, 0.011 + 5.0 * 0.5 / std::sqrt(kCount) / 0.25 / std::log(4.0));
  worst.look(static_cast<double>(row.refused) - kCount / 10.0, 1e-9);
  worst.look(row.series.mean_square() - 1.0, 5.0 / std::sqrt(kCount / parts));
  worst.look(static_cast<double>(row.series.samples()) - 1.0 * kCount / parts, 1e-9);
  return worst.figure();
}

/// States that a drive observes: sigma over that of prediction alone never above 1, that of place far below, each of
/// them by name; estimates unit normal over the sigma they should have, by chance 1 in 1e6.
StressFigure observed() {
  const Drive drive = simulated_drive(2, {.seconds = 15.0, .outage_from_s = 1e9});
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  PredictionAlone alone;
  alone.follow(filter);
  ErrorStateFilter without(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  without.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  StateRecord record;
  record.add(filter, alone);
  auto fix = drive.fixes.begin();
  Worst worst;
  for (const ImuSample& imu : drive.imu) {
    filter.predict(imu);
    without.predict(imu);
    while (fix != drive.fixes.end() && fix->t <= imu.t) filter.update(*fix++);
    record.add(filter, alone);
  }
  for (const StateHistory& state : record.states()) {
    worst.look(worse(state.share, 0.0) - 1.0 > 0.0 ? stress::kInfinity : 0.0, 1.0);
    if (state.block == "position") worst.look(state.share, 0.2);
    if (state.block == "position") worst.look(state.halved_after_s.value_or(stress::kInfinity), 15.0);
  }
  // The drift of the other filter goes another way, which linearizes its own steps: some parts in a thousand.
  const int n = filter.state().size();
  const Eigen::VectorXd by_itself = without.covariance().diagonal(), told = alone.covariance().diagonal().head(n);
  for (int i = 0; i < n; ++i)
    if (by_itself[i] > 0.0) worst.look(told[i] / by_itself[i] - 1.0, 0.1);
  return worst.figure();
}

/// A unit at rest for `hours`: every bound above what rounding has made, none of them endless or below nothing, and
/// with the growth that is stated: k = sqrt(2 G M / r^3) of height and velocity once that has the upper hand.
StressFigure growth(double hours) {
  const NavState truth = resting_at(45.0, 7.0, 200.0);
  const auto strapdown = make_strapdown("three_sample");
  const Increments in = rest_increments(truth, 1.0);
  NavState state = truth;
  RoundingGrowth bound(truth);
  Worst worst;
  const double k_per_s = std::sqrt(2.0 * 3.986004418e14 / std::pow(truth.p_EU_E.norm(), 3));
  double before_m = 0.0, before_m_s = 0.0;
  const int last = static_cast<int>(3600.0 * hours);
  for (int k = 1; k <= last; ++k) {
    strapdown->advance(state, in);
    bound.advance(state);
    worst.look((state.p_EU_E - truth.p_EU_E).norm(), bound.position_m());
    worst.look(state.v_EU_E.norm(), bound.velocity_m_s());
    if (k == last - 600) before_m = bound.position_m(), before_m_s = bound.velocity_m_s();
  }
  // Within ten minutes what drives it has grown by its own part, 600 s of the whole time.
  worst.look(std::log(bound.position_m() / before_m) / (600.0 * k_per_s) - 1.0, 600.0 / (3600.0 * hours));
  worst.look(std::log(bound.velocity_m_s() / before_m_s) / (600.0 * k_per_s) - 1.0, 600.0 / (3600.0 * hours));
  return worst.figure();
}

}  // namespace

std::vector<StressCase> verdict_cases() {
  const StressMechanism correlated{StressGroup::kLong, "how much a correlated series is worth",
                                   "lags beyond a ring that are no lags, a sum over them that counts each once",
                                   "a Markov process's own lags, worth and time: 5 sigma", "of the bound"};
  const StressMechanism covered{
      StressGroup::kData, "errors that are those of their covariance, or three times as large",
      "an ellipsoid of other axes, a share of another distribution, a false alarm",
      "each share to 5 sigma; found fault with where sigma is a third, and only there", "of the bound"};
  const StressMechanism innovated{StressGroup::kData, "innovations of one instant and of many",
                                  "parts of an epoch that count as instants; a median of binned numbers",
                                  "mean, median and number: 5 sigma, and the bins' 1 %", "of the bound"};
  const StressMechanism states{StressGroup::kLong, "what a run tells of each state",
                               "a share of another state's prediction",
                               "never more than prediction alone, of places far less", "of the bound"};
  const StressMechanism rounding{StressGroup::kLong, "the bound on what rounding may have grown to",
                                 "a bound below what rounding makes, or of another rate than gravity's",
                                 "above each error of rest, and growing as e^(k t) to its drive's share of the time",
                                 "of the bound"};
  StressRows rows;
  for (const double kept : {0.0, 0.5, 0.9, 0.99})
    rows.of(correlated).add("verdict/series_of_" + stress::text(kept), [kept] { return series(kept); });
  for (const double claimed : {1.0, 1.0 / 3.0})
    rows.of(covered).add(claimed == 1.0 ? "verdict/right_covariance" : "verdict/sigma_of_a_third",
                         [claimed] { return coverage(claimed); });
  for (const int parts : {1, 3})
    rows.of(innovated).add("verdict/innovations_in_" + std::to_string(parts), [parts] { return innovations(parts); });
  rows.of(states).add("verdict/states_of_a_drive", observed);
  rows.of(rounding).add("verdict/rounding_of_2_h", [] { return growth(2.0); });
  return rows.take();
}

}  // namespace canyon::fusion
