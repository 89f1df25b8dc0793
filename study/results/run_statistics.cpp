#include "canyon/study/results/run_statistics.h"

#include <algorithm>
#include <cmath>

#include "canyon/mission/recorder/estimate_error.h"
#include "canyon/study/results/summary.h"

namespace canyon::study {

void RunningError::add(double x) {
  const double size = std::abs(x);
  sum_squares_ += size * size;
  max_ = std::max(max_, size);
  ++count_;
}

double RunningError::rms() const {
  return count_ > 0 ? std::sqrt(sum_squares_ / static_cast<double>(count_)) : kNaN;
}

Status RunStatistics::epoch(const mission::NavRow& row) {
  const mission::EstimateError error = mission::estimate_error(row);
  const EpochError kept{row.t, error.position_W_m.x(), error.position_W_m.y(), error.position_W_m.z()};
  position_m_.add(kept.norm_m());
  if (position_square_m2_.samples() == 0) first_ = row.t;
  position_square_m2_.add(row.t - first_, error.position_W_m.squaredNorm());
  east_m_.add(kept.east_m);
  north_m_.add(kept.north_m);
  up_m_.add(kept.up_m);
  roll_deg_.add(error.attitude_deg.x());
  pitch_deg_.add(error.attitude_deg.y());
  yaw_deg_.add(error.attitude_deg.z());
  return errors_.append(kept);
}

Status RunStatistics::gnss(const mission::GnssRow& row) {
  const bool fixed = row.fix.status != FixStatus::kNone, first = fixes_due_++ == 0;
  const double gdop = row.fix.dop.gdop;
  has_satellites_ = has_satellites_ || row.has_satellites;
  const bool dop_step = fixed && had_fix_ && std::abs(gdop - last_gdop_) > kDopJump;
  if (!first && (fixed != had_fix_ || dop_step)) ++dop_jumps_;
  had_fix_ = fixed;
  last_gdop_ = gdop;
  for (const GnssObservationTruth& satellite : row.truth.satellites) {
    if (!satellite.tracked) continue;
    ++tracked_;
    nlos_ += satellite.line_of_sight ? 0 : 1;
    multipath_ += satellite.line_of_sight && satellite.reflections > 0 ? 1 : 0;
  }
  if (!fixed) return Ok{};
  ++fixes_;
  satellites_ += row.fix.satellites;
  fix_m_.add((frame_.to_W(row.fix.p_A_E) - row.p_A_W_true).norm());
  if (!std::isfinite(gdop)) return Ok{};
  gdop_.add(gdop);
  return dilutions_.append({gdop, row.fix.dop.pdop});
}

Status RunStatistics::keyframe(const mission::KeyframeRow& row) {
  ++keyframes_;
  prior_m_.add((row.X_WL_prior.p - row.X_WL_true.p).norm());
  registered_m_.add((row.X_WL_registered.p - row.X_WL_true.p).norm());
  tried_ += row.status ? 1 : 0;
  converged_ += row.status == lidar::RegistrationStatus::kConverged ? 1 : 0;
  return Ok{};
}

namespace {

/// p95 by nearest rank.
template <class Value>
Result<ErrorStatistics> statistics_of(const RunningError& running, const RowStore<EpochError>& rows,
                                      const Value& value) {
  ErrorStatistics out{running.rms(), kNaN, running.max()};
  if (rows.size() == 0) return out;
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(rows.size())));
  CANYON_TRY(out.p95, rows.ranked(rank - 1, [&](const EpochError& row) { return std::abs(value(row)); }));
  return out;
}

template <class Row>
Result<double> median_of(const RowStore<Row>& rows, double Row::*value) {
  const std::size_t count = rows.size(), half = count / 2;
  if (count == 0) return kNaN;
  const auto ranked = [&](std::size_t k) { return rows.ranked(k, [&](const Row& row) { return row.*value; }); };
  CANYON_TRY(const double upper, ranked(half));
  if (count % 2 == 1) return upper;
  CANYON_TRY(const double lower, ranked(half - 1));
  return 0.5 * (lower + upper);
}

}  // namespace

Status RunStatistics::fill_gnss(RunSummary& out) const {
  CANYON_TRY(out.gdop_median, median_of(dilutions_, &Dilution::gdop));
  CANYON_TRY(out.pdop_median, median_of(dilutions_, &Dilution::pdop));
  out.gdop_max = gdop_.max();
  out.fixes_due = fixes_due_;
  out.fixes_lost = fixes_due_ - fixes_;
  out.fix_error_rms_m = fix_m_.rms();
  if (has_satellites_) {
    out.dop_jumps = dop_jumps_;
    if (fixes_ > 0) out.satellites_mean = static_cast<double>(satellites_) / fixes_;
  }
  if (tracked_ > 0) {
    out.nlos_share = static_cast<double>(nlos_) / static_cast<double>(tracked_);
    out.multipath_share = static_cast<double>(multipath_) / static_cast<double>(tracked_);
  }
  return Ok{};
}

Status RunStatistics::fill(RunSummary& out, bool registers) const {
  CANYON_TRY(out.position_m, statistics_of(position_m_, errors_, [](const EpochError& e) { return e.norm_m(); }));
  // Where the interval of the mean square reaches zero, batches are too few and too unlike to say anything.
  if (const Interval square = position_square_m2_.interval(); square.defined() && square.low > 0.0)
    out.position_rms_interval_m = {std::sqrt(square.low), std::sqrt(square.high)};
  CANYON_TRY(out.east_m, statistics_of(east_m_, errors_, [](const EpochError& e) { return e.east_m; }));
  CANYON_TRY(out.north_m, statistics_of(north_m_, errors_, [](const EpochError& e) { return e.north_m; }));
  CANYON_TRY(out.up_m, statistics_of(up_m_, errors_, [](const EpochError& e) { return e.up_m; }));
  out.roll_rms_deg = roll_deg_.rms();
  out.pitch_rms_deg = pitch_deg_.rms();
  out.yaw_rms_deg = yaw_deg_.rms();
  CANYON_TRY_STATUS(fill_gnss(out));
  out.keyframes = keyframes_;
  out.registration_prior_rms_m = prior_m_.rms();
  if (!registers) return Ok{};
  out.keyframes_registered = tried_;
  out.keyframes_converged = converged_;
  out.registration_rms_m = registered_m_.rms();
  return Ok{};
}

}  // namespace canyon::study
