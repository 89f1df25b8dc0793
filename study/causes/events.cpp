#include "canyon/study/causes/events.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/truth.h"
#include "canyon/mission/scoring/scorer.h"
#include "canyon/study/results/run_statistics.h"

namespace canyon::study {

ModelTable<EventKind> event_kinds() {
  static constexpr ModelRow<EventKind> kRows[] = {
      {"dop_jump", EventKind::kDilutionJump, "GDOP changes by more than 2 from fix to fix"},
      {"hidden_signals", EventKind::kHiddenSignals, "signals of hidden satellites are in the fix"},
      {"fix_lost", EventKind::kFixLost, "no fix"},
      {"unlikely_fix", EventKind::kUnlikelyFix, "the filter takes a fix whose innovation is beyond its 99.9 % bound"},
      {"overconfident", EventKind::kOverconfident, "the position is off by more than three of the filter's own sigma"},
      {"map_doubled", EventKind::kMapDoubled,
       "keyframes less than 10 m apart are placed by errors that differ by more than 0.5 m: what both see stands "
       "twice"},
      {"phantom", EventKind::kPhantom, "the autonomy finds no way, where the true body would have one"},
      {"stopped", EventKind::kStopped, "the autonomy stands before something, or sees nothing"},
  };
  return kRows;
}

double first_plan_by_s(const mission::MissionConfig& config) {
  return 2.0 / config.lidar.rate_hz + config.lidar.latency_s + mission::Scorer::kFirstPlan_s;
}

void RunEvents::see(EventKind kind, GpsTime t, double size) {
  const double at_s = t - start_;
  const auto last = std::find_if(events_.rbegin(), events_.rend(), [kind](const Event& e) { return e.kind == kind; });
  if (last != events_.rend() && at_s - last->to_s <= kEventGap_s) {
    last->to_s = at_s;
    last->size = std::max(last->size, size);
    return;
  }
  events_.push_back({kind, at_s, at_s, size});
}

Status RunEvents::gnss(const mission::GnssRow& row) {
  if (!started_) start_ = row.fix.t;
  started_ = true;
  const bool fixed = row.fix.status != FixStatus::kNone;
  const double change = std::abs(row.fix.dop.gdop - last_gdop_);
  if (fixed && had_fix_ && change > kDopJump) see(EventKind::kDilutionJump, row.fix.t, change);
  if (!fixed) see(EventKind::kFixLost, row.fix.t, 1.0);
  had_fix_ = fixed;
  last_gdop_ = row.fix.dop.gdop;
  const auto hidden = std::count_if(row.truth.satellites.begin(), row.truth.satellites.end(),
                                    [](const GnssObservationTruth& s) { return s.tracked && !s.line_of_sight; });
  if (fixed && hidden > 0) see(EventKind::kHiddenSignals, row.fix.t, static_cast<double>(hidden));
  const fusion::UpdateReport& update = row.update;
  if (update.accepted && update.dimension > 0) {
    constexpr double kUnlikely = 1e-3;
    const double bound = chi_square_threshold(kUnlikely, update.dimension);
    if (update.nis > bound) see(EventKind::kUnlikelyFix, row.fix.t, update.nis / bound);
  }
  return Ok{};
}

Status RunEvents::epoch(const mission::NavRow& row) {
  if (!started_) start_ = row.t;
  started_ = true;
  const Eigen::Vector3d error_B = row.estimate.X_WB.R.conjugate() * (row.X_WB_true.p - row.estimate.X_WB.p);
  const Eigen::Matrix3d covariance_B = row.estimate.pose_covariance.bottomRightCorner<3, 3>();
  // As probable as 3 sigma of one axis are; an epoch whose covariance says nothing is not judged.
  constexpr double kBeyond3Sigma = 0.0027;
  static const double bound = chi_square_threshold(kBeyond3Sigma, 3);
  if (covariance_B.determinant() > 0.0) {
    const double square = error_B.dot(covariance_B.inverse() * error_B);
    if (square > bound) see(EventKind::kOverconfident, row.t, std::sqrt(square / bound));
  }
  if (row.phantom) see(EventKind::kPhantom, row.t, 1.0);
  see_standing(row.state == mission::AutonomyState::kBlocked || row.state == mission::AutonomyState::kBlind, row.t);
  return Ok{};
}

void RunEvents::see_standing(bool stands, GpsTime t) {
  if (waits_ && stands && t - start_ < first_plan_by_s_) {
    if (!waited_) waited_ = t;
    return;
  }
  const bool since_start = waits_ && stands && waited_;  // that was no wait
  waits_ = false;
  if (stands) see(EventKind::kStopped, t, 1.0);
  if (since_start) events_.back().from_s = *waited_ - start_;
}

Status RunEvents::keyframe(const mission::KeyframeRow& row) {
  if (!started_) start_ = row.t;
  started_ = true;
  const Placed now{row.X_WL_true.p, row.X_WL_registered.p - row.X_WL_true.p};
  const auto cell = [](double x) { return static_cast<int>(std::floor(x / kSameSurfaces_m)); };
  const int x = cell(now.p_W.x()), y = cell(now.p_W.y());
  double apart_m = 0.0;
  for (int i = x - 1; i <= x + 1; ++i) {
    for (int j = y - 1; j <= y + 1; ++j) {
      const auto there = placed_.find({i, j});
      if (there == placed_.end()) continue;
      for (const Placed& before : there->second)
        if ((before.p_W - now.p_W).norm() < kSameSurfaces_m)
          apart_m = std::max(apart_m, (before.off_W - now.off_W).norm());
    }
  }
  if (apart_m > kDoubled_m) see(EventKind::kMapDoubled, row.t, apart_m);
  placed_[{x, y}].push_back(now);
  return Ok{};
}

std::vector<Event> RunEvents::events() const {
  std::vector<Event> sorted = events_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Event& a, const Event& b) { return a.from_s < b.from_s; });
  return sorted;
}

double chain_start_s(const std::vector<Event>& events, double failed_s) {
  constexpr double kGap_s = 10.0, kLongest_s = 60.0;
  double start_s = failed_s;
  // By their ends, the last first: one that began earlier may end later.
  std::vector<Event> by_end = events;
  std::stable_sort(by_end.begin(), by_end.end(), [](const Event& a, const Event& b) { return a.to_s > b.to_s; });
  for (const Event& event : by_end) {
    const bool follows =
        event.kind == EventKind::kStopped || event.kind == EventKind::kPhantom || event.kind == EventKind::kMapDoubled;
    if (follows || event.from_s >= failed_s) continue;
    if (event.to_s < start_s - kGap_s) break;
    start_s = std::min(start_s, event.from_s);
  }
  if (start_s == failed_s) start_s = failed_s - kGap_s;
  return std::max({0.0, start_s, failed_s - kLongest_s});
}

}  // namespace canyon::study
