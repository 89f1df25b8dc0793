#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"
#include "canyon/fusion/verdict/verdict.h"

namespace canyon::fusion {
namespace {

/// Two-sided band of a mean of squares of `degrees` independent unit normals.
Band mean_square_band(double degrees, double false_alarm) {
  return {.low = chi_square_threshold(1.0 - 0.5 * false_alarm, degrees) / degrees,
          .high = chi_square_threshold(0.5 * false_alarm, degrees) / degrees};
}

/// Only too large can be told of errors that are alike for a while: where chance has made the slow part of them small,
/// what is left looks like many independent samples, and a right filter would be found too cautious (of 40 of them 19
/// were). Where it has made it large they look the more alike, which errs on the safe side.
Band upper_band(double degrees, double false_alarm) {
  return {.low = 0.0, .high = chi_square_threshold(false_alarm, degrees) / degrees};
}

/// Squares of a series whose samples are alike for a while.
SquareMean correlated(const NormalSeries& series, double false_alarm) {
  if (series.samples() == 0) return {};
  const double effective = series.effective_samples();
  return {series.mean_square(), static_cast<double>(series.samples()), effective,
          upper_band(series.dimension() * effective, false_alarm)};
}

Whiteness whiteness(const NormalSeries& series, double false_alarm) {
  const auto [statistic, degrees] = series.portmanteau();
  if (degrees == 0) return {};
  return {series.lags().front().r, statistic, chi_square_threshold(false_alarm, degrees), series.correlation_s(),
          series.interval_s()};
}

MeasurementNumbers measurement(const std::string& name, const InnovationRow& row, double false_alarm) {
  const auto degrees = static_cast<double>(row.dimensions);
  const auto count = static_cast<double>(row.count);
  return {name,
          count,
          static_cast<double>(row.refused),
          {row.nis_per_dimension(), count, count, mean_square_band(degrees, false_alarm)},
          row.nis_median_ratio(),
          whiteness(row.series, false_alarm)};
}

AxisNumbers axis(const std::string& block, const AxisErrors& errors, double false_alarm) {
  const auto n = static_cast<double>(errors.series.samples());
  return {block,
          errors.name,
          errors.unit,
          std::sqrt(errors.error_squares / n),
          std::sqrt(errors.variances / n),
          correlated(errors.series, false_alarm)};
}

BlockNumbers block(const BlockErrors& errors, double false_alarm) {
  return {errors.name,
          correlated(errors.series, false_alarm),
          {errors.coverage(0), errors.coverage(1), errors.coverage(2)},
          errors.series.correlation_s()};
}

/// States whose names differ in their last word alone have one process: "gyro bias", "gyro scale".
std::map<std::string, std::vector<const StateHistory*>> by_process(const StateRecord& record) {
  std::map<std::string, std::vector<const StateHistory*>> out;
  for (const StateHistory& state : record.states()) {
    if (state.estimate.samples() == 0) continue;
    out[state.name.substr(0, state.name.rfind(' '))].push_back(&state);
  }
  return out;
}

/// Estimates of several states are nearly independent where their priors are: from a quarter of the prior variance on
/// down, two of them correlate by less than (1/4) / (3/4), the covariance of estimates being that of the prior less
/// that of the errors. So n of them are worth n / (1 + (n - 1) / 9) at least.
ProcessNumbers process(const std::string& name, const std::vector<const StateHistory*>& states, double false_alarm) {
  double squares = 0.0, samples = 0.0, effective = 0.0;
  for (const StateHistory* state : states) {
    const auto n = static_cast<double>(state->estimate.samples());
    squares += state->estimate.mean_square() * n;
    samples += n;
    effective += state->estimate.effective_samples();
  }
  const auto n = static_cast<double>(states.size());
  effective /= 1.0 + (n - 1.0) / 9.0;
  return {name, {squares / samples, samples, effective, upper_band(effective, false_alarm)}};
}

bool carries_fix_error(const StateRecord& record) {
  return std::any_of(record.states().begin(), record.states().end(),
                     [](const StateHistory& state) { return state.block == "fix_error"; });
}

}  // namespace

void FixRecord::add(GpsTime t, const Eigen::Vector3d& error_m, const Eigen::Matrix3d& covariance_m2) {
  const auto whole = covariance_m2.llt();
  if (!error_m.allFinite() || whole.info() != Eigen::Success) return;
  series.add(t, whole.matrixL().solve(error_m));
  squares_m2 += error_m.squaredNorm() / 3.0;
  variances_m2 += covariance_m2.trace() / 3.0;
}

VerdictNumbers verdict_numbers(const VerdictEvidence& evidence, double false_alarm) {
  const auto rows =
      evidence.innovations != nullptr ? evidence.innovations->rows() : decltype(InnovationRecord().rows())();
  const auto processes =
      evidence.states != nullptr ? by_process(*evidence.states) : decltype(by_process(StateRecord()))();
  const bool has_fixes = evidence.fixes != nullptr && evidence.fixes->series.samples() > 0;
  VerdictNumbers out;
  out.tests = static_cast<int>(2 * rows.size() + processes.size()) + (has_fixes ? 2 : 0);
  if (evidence.errors != nullptr)
    for (const BlockErrors& b : evidence.errors->blocks())
      if (b.series.samples() > 0) out.tests += 1 + (b.axes.size() > 1 ? static_cast<int>(b.axes.size()) : 0);
  out.false_alarm = false_alarm / std::max(out.tests, 1);

  for (const auto& [name, row] : rows) out.measurements.push_back(measurement(name, row, out.false_alarm));
  for (const auto& [name, states] : processes) out.processes.push_back(process(name, states, out.false_alarm));
  if (evidence.errors != nullptr)
    for (const BlockErrors& b : evidence.errors->blocks()) {
      if (b.series.samples() == 0) continue;
      out.blocks.push_back(block(b, out.false_alarm));
      for (const AxisErrors& a : b.axes) out.axes.push_back(axis(b.name, a, out.false_alarm));
    }
  if (has_fixes) {
    const FixRecord& fixes = *evidence.fixes;
    const auto n = static_cast<double>(fixes.series.samples());
    out.fixes = FixNumbers{std::sqrt(fixes.squares_m2 / n), std::sqrt(fixes.variances_m2 / n),
                           correlated(fixes.series, out.false_alarm), whiteness(fixes.series, out.false_alarm),
                           evidence.states != nullptr && carries_fix_error(*evidence.states)};
  }
  if (evidence.states != nullptr) {
    for (const StateHistory& state : evidence.states->states())
      out.states.push_back(
          {state.block, state.name, state.share, state.least_share, state.halved_after_s, state.shares});
    out.looked_s = evidence.states->times_s();
  }
  return out;
}

}  // namespace canyon::fusion
