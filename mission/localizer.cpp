#include "canyon/mission/localizer.h"

#include "canyon/fusion/divided_sample.h"

namespace canyon::mission {

void Localizer::gather(fusion::RunEvidence& evidence) {
  evidence_ = &evidence;
  evidence.follow(filter_);
}

void Localizer::look() {
  if (evidence_ != nullptr) evidence_->look(filter_);
}

void Localizer::tell(std::size_t from) {
  if (evidence_ == nullptr) return;
  for (std::size_t i = from; i < filter_.reports().size(); ++i) evidence_->innovation(filter_.reports()[i]);
}

Status Localizer::take(ImuSample sample, GpsTime t) {
  while (!waiting_.empty() && waiting_.front().t < t) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    if (next.t > at_) CANYON_TRY_STATUS(predict(fusion::take_share(sample, (next.t - at_) / (t - at_)), next.t));
    CANYON_TRY_STATUS(next.work());
  }
  CANYON_TRY_STATUS(predict(sample, t));
  while (!waiting_.empty() && waiting_.front().t == t) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    CANYON_TRY_STATUS(next.work());
  }
  return Ok{};
}

Status Localizer::once_at(GpsTime t, std::function<Status()> work) {
  if (at_ == t) return work();
  waiting_.push_back({t, std::move(work)});
  return Ok{};
}

Status Localizer::predict(const ImuSample& sample, GpsTime t) {
  clock_.charge(Part::kFilter, [&] {
    filter_.predict(sample);
    if (without_fixes_) without_fixes_->predict(sample);
  });
  ++predictions_;
  const Pose predicted = filter_.predicted_pose();
  motion_ = motion_ * (X_WB_.inverse() * predicted);
  X_WB_ = predicted;
  if (!filter_.reports().empty()) corrected();
  tell(0);
  at_ = t;
  return boundaries_.check(filter_.estimate());
}

RelativePose Localizer::motion() const {
  RelativePose motion{.source = at_, .target = motion_start_, .X_TS = motion_};
  if (without_fixes_) motion.covariance = without_fixes_->motion().covariance;
  return motion;
}

void Localizer::begin_motion() {
  motion_ = Pose();
  motion_start_ = at_;
  without_fixes_.emplace(filter_);
}

void Localizer::corrected() {
  const Pose before = std::exchange(X_WB_, filter_.estimate().X_WB);
  const Pose by = X_WB_ * before.inverse();
  correction_ = correction_ ? by * *correction_ : by;
}

Status Localizer::aid(const fusion::AidingMessage& message) {
  const std::size_t reports = filter_.reports().size();
  clock_.charge(Part::kFilter, [&] {
    filter_.update(message);
    if (without_fixes_ && fusion::is_of_motion(message)) without_fixes_->update(message);
  });
  if (filter_.reports().size() > reports) corrected();
  tell(reports);
  return boundaries_.check(filter_.estimate());
}

Status Localizer::update(const RelativePose& since_clone) {
  RelativePose by_its_clock = since_clone;
  by_its_clock.source = filter_.nav_state().t;
  by_its_clock.target = clone_by_its_clock_;
  return aid(by_its_clock);
}

Status Localizer::update(const PoseInMap& pose) {
  PoseInMap by_its_clock = pose;
  by_its_clock.t = filter_.nav_state().t;
  return aid(by_its_clock);
}

Status Localizer::update(const GnssEpoch& epoch) {
  GnssEpoch by_its_clock = epoch;
  by_its_clock.t.ns += filter_.nav_state().t.ns - at_.ns;
  return aid(by_its_clock);
}

void Localizer::take_clone() {
  filter_.take_clone();
  clone_by_its_clock_ = filter_.nav_state().t;
}

Result<fusion::UpdateReport> Localizer::update(const GnssFix& fix) {
  // Whoever divides samples at the times of fixes knows what the unit's clock, which is never set, shows at at_.
  GnssFix by_its_clock = fix;
  by_its_clock.t.ns += filter_.nav_state().t.ns - at_.ns;
  const std::size_t reports = filter_.reports().size();
  fusion::UpdateReport report = clock_.charge(Part::kFilter, [&] { return filter_.update(by_its_clock); });
  if (evidence_ != nullptr) evidence_->innovation(report);
  tell(reports);
  report.t = fix.t;
  updates_ += report.dimension > 0 ? 1 : 0;
  if (report.accepted || !filter_.reports().empty()) corrected();
  return report;
}

}  // namespace canyon::mission
