#include "canyon/study/registration_error/events/keyframe_series.h"

#include <algorithm>
#include <cmath>

#include "canyon/study/registration_error/scan_error.h"

namespace canyon::study {

double ErrorSeries::at(std::size_t series, double when_s) const {
  const auto after = std::lower_bound(t_s.begin(), t_s.end(), when_s);
  if (after == t_s.end()) return kNaN;
  const auto k = static_cast<std::size_t>(after - t_s.begin());
  if (*after == when_s) return errors[k][series];
  if (k == 0 || t_s[k] - t_s[k - 1] > kLongestGap_s) return kNaN;
  const double share = (when_s - t_s[k - 1]) / (t_s[k] - t_s[k - 1]);
  return (1.0 - share) * errors[k - 1][series] + share * errors[k][series];
}

Status SeriesRecorder::gnss(const mission::GnssRow& row) {
  last_fix_s_ = row.fix.t - start_;
  if (!first_fix_s_) first_fix_s_ = last_fix_s_;
  return fixes_.gnss(row);
}

Status SeriesRecorder::keyframe(const mission::KeyframeRow& row) {
  X_WL_prior_ = row.X_WL_prior;
  X_WL_registered_ = row.X_WL_registered;
  const double prior_m = (row.X_WL_prior.p - row.X_WL_true.p).norm();
  const double registered_m = (row.X_WL_registered.p - row.X_WL_true.p).norm();
  series_.t_s.push_back(row.t - start_);
  series_.errors.push_back({prior_m, registers_ ? registered_m : kNaN, kNaN, kNaN});
  return Ok{};
}

Status SeriesRecorder::keyframe_input(const mission::KeyframeInput& input) {
  jumps_.add(input.deskewed.t - start_, input.estimate, input.motion);
  const auto points = sampled_points(input.deskewed, map_range_m_);
  KeyframeErrors& errors = series_.errors.back();
  errors[2] = std::sqrt(placed_error_m2(points, X_WL_prior_, scene_));
  if (registers_) errors[3] = std::sqrt(placed_error_m2(points, X_WL_registered_, scene_));
  return Ok{};
}

ErrorSeries SeriesRecorder::take() {
  series_.events = fix_events(fixes_.events(), first_fix_s_.value_or(0.0), last_fix_s_, gnss_period_s_);
  series_.events.insert(series_.events.end(), jumps_.events().begin(), jumps_.events().end());
  return std::move(series_);
}

}  // namespace canyon::study
