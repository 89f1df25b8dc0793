#include "canyon/mission/localizer.h"

namespace canyon::mission {

namespace {

/// Takes the first share (0 to 1) of an IMU sample off it: rate and force count as constant over the sample.
ImuSample take_share(ImuSample& sample, double share) {
  ImuSample first = sample;
  first.dt_s *= share;
  first.dtheta_U *= share;
  first.dv_U *= share;
  sample.dt_s -= first.dt_s;
  sample.dtheta_U -= first.dtheta_U;
  sample.dv_U -= first.dv_U;
  first.t = sample.t - sample.dt_s;
  return first;
}

}  // namespace

Status Localizer::take(ImuSample sample, GpsTime t) {
  while (!waiting_.empty() && waiting_.front().t < t) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    if (next.t > at_) CANYON_TRY_STATUS(predict(take_share(sample, (next.t - at_) / (t - at_)), next.t));
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
  clock_.charge(Part::kFilter, [&] { filter_.predict(sample); });
  ++predictions_;
  if (!filter_.reports().empty()) corrected(filter_.predicted_pose());
  at_ = t;
  return boundaries_.check(filter_.estimate());
}

void Localizer::corrected(const Pose& before) {
  const Pose by = filter_.estimate().X_WB * before.inverse();
  correction_ = correction_ ? by * *correction_ : by;
}

Status Localizer::update(const OdometerSample& sample) {
  const Pose before = filter_.estimate().X_WB;
  const std::size_t reports = filter_.reports().size();
  clock_.charge(Part::kFilter, [&] { filter_.update(fusion::AidingMessage(sample)); });
  if (filter_.reports().size() > reports) corrected(before);
  return boundaries_.check(filter_.estimate());
}

Result<fusion::UpdateReport> Localizer::update(const GnssFix& fix) {
  // Whoever divides samples at the times of fixes knows what the unit's clock, which is never set, shows at at_.
  GnssFix by_its_clock = fix;
  by_its_clock.t.ns += filter_.nav_state().t.ns - at_.ns;
  const Pose before = filter_.estimate().X_WB;
  fusion::UpdateReport report = clock_.charge(Part::kFilter, [&] { return filter_.update(by_its_clock); });
  report.t = fix.t;
  updates_ += report.dimension > 0 ? 1 : 0;
  if (report.accepted || !filter_.reports().empty()) corrected(before);
  return report;
}

}  // namespace canyon::mission
