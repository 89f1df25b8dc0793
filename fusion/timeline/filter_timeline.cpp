#include "canyon/fusion/timeline/filter_timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/fusion/divided_sample.h"

namespace canyon::fusion {
namespace {

/// Between copies to go back to, and between the steps of a long gap.
constexpr double kMostAge_s = 0.1;  // ErrorStateFilter::update(const GnssFix&)
constexpr double kApart_s = 0.1;

bool is_finite(const ImuSample& s) {
  return std::isfinite(s.dt_s) && s.dt_s > 0.0 && s.dtheta_U.allFinite() && s.dv_U.allFinite();
}

template <class Matrix>
bool is_covariance(const Matrix& P) {
  return P.allFinite() && (0.5 * (P + P.transpose())).eval().llt().info() == Eigen::Success;
}

bool is_finite(const GnssFix& fix) {
  return fix.p_A_E.allFinite() && is_covariance(fix.covariance_E);
}
bool is_finite(const GnssEpoch&) {
  return true;  // what is not finite in it is left out satellite by satellite
}
bool is_finite(const OdometerSample& s) {
  return std::isfinite(s.speed_m_s) && std::isfinite(s.dt_s) && s.dt_s > 0.0;
}
bool is_finite(const BarometerSample& s) {
  return std::isfinite(s.pressure_pa);
}
bool is_finite(const MagnetometerSample& s) {
  return s.field_U_t.allFinite();
}
bool is_finite(const HeadingSample& s) {
  return std::isfinite(s.heading_rad) && std::isfinite(s.sigma_rad) && s.sigma_rad > 0.0;
}
bool is_finite(const RelativePose& m) {
  return m.X_TS.R.coeffs().allFinite() && m.X_TS.p.allFinite() && is_covariance(m.covariance);
}
bool is_finite(const PoseInMap& m) {
  return m.X_WB.R.coeffs().allFinite() && m.X_WB.p.allFinite() && is_covariance(m.covariance);
}

}  // namespace

void visit(FieldVisitor& f, TimelineConfig& c) {
  f.number("wait_s", c.wait_s, {0, 3600}, "so far back messages are taken in their place");
  f.number("held_s", c.held_s, {0, 10},
           "in a gap of the IMU the last rates hold so long; then nothing turns or pushes");
  f.number("gap_rate_deg_s", c.gap_rate_deg_s, {0, 1e4}, "1-sigma of the rate of turn that is not known in a gap");
  f.number("gap_force_m_s2", c.gap_force_m_s2, {0, 1e4}, "1-sigma of the force that is not known in a gap");
  f.number("frozen_speed_m_s", c.frozen_speed_m_s, {0.01, 1e4},
           "estimated speed from which a fix that stands still to the bit is none");
}

TimelineConfig TimelineConfig::as_recorded() {
  TimelineConfig out;
  out.wait_s = 0.0;
  out.gap_rate_deg_s = out.gap_force_m_s2 = 0.0;
  out.frozen_speed_m_s = std::numeric_limits<double>::infinity();
  out.same_instant_s = 0.0;
  return out;
}

FilterTimeline::FilterTimeline(ErrorStateFilter filter, const TimelineConfig& config, std::optional<GpsTime> at)
    : filter_(std::move(filter)), config_(config), at_(at.value_or(filter_.nav_state().t)), reached_(at_) {
  checkpoints_.push_back({filter_, at_, 0});
}

void FilterTimeline::watch(FilterObserver* observer) {
  observer_ = observer;
  filter_.watch(observer);
}

std::size_t FilterTimeline::waiting() const {
  return static_cast<std::size_t>(std::count_if(events_.begin() + (next_ - first_), events_.end(), [](const Event& e) {
    return std::holds_alternative<AidingMessage>(e.what);
  }));
}

Trouble FilterTimeline::add(const ImuSample& given, GpsTime at) {
  const auto told = [&](Trouble trouble) {
    if (trouble != Trouble::kNone) incidents_.add(trouble, at);
    return trouble;
  };
  if (!is_finite(given)) return told(Trouble::kNotFinite);
  const double since_s = at - reached_;
  if (std::abs(since_s) <= config_.same_instant_s) return told(Trouble::kDuplicate);
  if (since_s < 0.0) return told(Trouble::kReversed);
  ImuSample sample = given;
  Trouble trouble = sample.lost ? Trouble::kLost : Trouble::kNone;
  double gap_s = sample.lost ? sample.dt_s : 0.0;
  const double missing_s = since_s - sample.dt_s;
  if (missing_s > 0.5 * sample.dt_s) {
    trouble = Trouble::kGap;
    bridged_s_ += missing_s;
    bridge(at - sample.dt_s, sample.dt_s, given.t.ns - at.ns, true);
  } else if (missing_s < -0.5 * sample.dt_s) {
    take_share(sample, -missing_s / sample.dt_s);  // what has come before
  }
  last_imu_ = sample;
  reached_ = at;
  insert_motion({.t = at, .own = given.t, .what = sample, .gap_s = gap_s});
  run();
  return told(trouble);
}

void FilterTimeline::insert_motion(Event event) {
  auto at = events_.end();
  while (at != events_.begin() + (next_ - first_) && std::prev(at)->t - event.t >= -config_.same_instant_s) --at;
  events_.insert(at, std::move(event));
}

void FilterTimeline::bridge(GpsTime to, double dt_s, std::int64_t own_ns, bool loosens) {
  const double gap_s = to - reached_;
  GpsTime held_to = reached_;
  held_to.ns += static_cast<std::int64_t>(1e9 * config_.held_s);
  std::vector<Event> parts;
  for (GpsTime t = reached_; to - t > config_.same_instant_s;) {
    const bool hold = last_imu_.has_value() && t < held_to;
    const GpsTime from = t;
    const double left_s = to - t, step_s = hold ? dt_s : std::max(dt_s, kApart_s);
    t = left_s < 1.5 * step_s ? to : GpsTime{.ns = t.ns + static_cast<std::int64_t>(std::llround(1e9 * step_s))};
    Event part{.t = t, .own = GpsTime{.ns = t.ns + own_ns}, .what = Coast{t - from}};
    if (hold) {
      ImuSample again = *last_imu_;
      const double share = (t - from) / again.dt_s;
      again.t = part.own;
      again.dt_s = t - from;
      again.dtheta_U *= share;
      again.dv_U *= share;
      again.lost = true;
      part.what = again;
    }
    parts.push_back(part);
  }
  if (parts.empty()) return;
  if (loosens) parts.back().gap_s = gap_s;
  for (Event& part : parts) insert_motion(std::move(part));
}

void FilterTimeline::coast(GpsTime to) {
  if (to - reached_ <= config_.same_instant_s) return;
  last_imu_.reset();
  bridge(to, kApart_s, filter_.nav_state().t.ns - at_.ns, false);
  reached_ = to;
  run();
}

void FilterTimeline::look(GpsTime t) {
  if (at_ - t > config_.same_instant_s) return;
  auto at = events_.end();
  while (at != events_.begin() + (next_ - first_) && std::prev(at)->t > t) --at;
  events_.insert(at, {.t = t, .own = t, .what = Look{}});
  run();
}

GpsTime FilterTimeline::due(const AidingMessage& message) const {
  GpsTime t = time_of(message);
  const bool of_receiver = std::holds_alternative<GnssFix>(message) || std::holds_alternative<GnssEpoch>(message);
  const int offset = filter_.offset("time_offset");
  if (of_receiver && offset >= 0) t.ns += static_cast<std::int64_t>(std::llround(1e9 * filter_.value(offset)));
  return t;
}

Trouble FilterTimeline::judge(const AidingMessage& message) {
  if (!std::visit([](const auto& m) { return is_finite(m); }, message)) return Trouble::kNotFinite;
  const GpsTime stamp = time_of(message);
  for (const Event& e : events_) {
    const auto* other = std::get_if<AidingMessage>(&e.what);
    if (other != nullptr && other->index() == message.index() && time_of(*other) == stamp) return Trouble::kDuplicate;
  }
  const auto* fix = std::get_if<GnssFix>(&message);
  if (fix == nullptr) return Trouble::kNone;
  const bool frozen = last_fix_ && fix->t > last_fix_->t && fix->p_A_E == last_fix_->p_A_E &&
                      filter_.nav_state().v_EU_E.norm() > config_.frozen_speed_m_s;
  last_fix_ = *fix;
  return frozen ? Trouble::kFrozen : Trouble::kNone;
}

Trouble FilterTimeline::add(const AidingMessage& message, GpsTime t) {
  const auto* fix = std::get_if<GnssFix>(&message);
  if (fix != nullptr && fix->status == FixStatus::kNone) return Trouble::kNone;
  const auto told = [&](Trouble trouble) {
    if (trouble != Trouble::kNone) incidents_.add(trouble, time_of(message));
    return trouble;
  };
  if (const Trouble trouble = judge(message); trouble != Trouble::kNone) return told(trouble);
  std::int64_t at = end();
  while (at > first_ && event(at - 1).t > t) --at;
  if (at < next_ || at_ - t > config_.same_instant_s) {
    if (at < checkpoints_.front().next || checkpoints_.front().at - t > config_.same_instant_s)
      return told(Trouble::kTooLate);
    go_back(at);
  }
  events_.insert(events_.begin() + (at - first_), {.t = t, .own = t, .what = message});
  run();
  return told(t - reached_ > config_.same_instant_s ? Trouble::kAhead : Trouble::kNone);
}

void FilterTimeline::go_back(std::int64_t to) {
  while (checkpoints_.back().next > to) checkpoints_.pop_back();
  // A copy made within a sample would not know what is left of it: there is none.
  filter_ = checkpoints_.back().filter;
  at_ = checkpoints_.back().at;
  next_ = checkpoints_.back().next;
  rest_.reset();
  ++replays_;
}

void FilterTimeline::run() {
  while (next_ < end()) {
    Event& e = event(next_);
    if (e.moves()) {
      move(e);
    } else {
      if (!reach(e)) return;
      if (const auto* message = std::get_if<AidingMessage>(&e.what)) take(*message, e.done);
      if (std::holds_alternative<Look>(e.what) && !e.done && on_look) on_look(filter_);
    }
    e.done = true;
    ++next_;
    if (e.moves() && at_ - checkpoints_.back().at >= kApart_s) {
      checkpoints_.push_back({filter_, at_, next_});
      forget();
    }
  }
}

ImuSample FilterTimeline::motion_of(const Event& e) const {
  if (rest_) return *rest_;
  if (const auto* sample = std::get_if<ImuSample>(&e.what)) return *sample;
  // As a unit with these errors puts out that neither turns nor is pushed.
  const NavState& nav = filter_.nav_state();
  const Calibration imu = filter_.calibration();
  const double dt_s = std::get<Coast>(e.what).dt_s;
  const Eigen::Vector3d w_U = nav.R_EU.conjugate() * earth_rate_E();
  const Eigen::Vector3d f_U = nav.R_EU.conjugate() * (2.0 * earth_rate_E().cross(nav.v_EU_E) - gravity_E(nav.p_EU_E));
  ImuSample out;
  out.t = e.own;
  out.dt_s = dt_s;
  out.dtheta_U = dt_s * (w_U + imu.gyro_gain * w_U + imu.gyro_bias);
  out.dv_U = dt_s * (f_U + imu.accel_gain * f_U + imu.accel_bias);
  return out;
}

void FilterTimeline::move(Event& e) {
  const ImuSample sample = motion_of(e);
  rest_.reset();
  predict(sample, e.t, e.done);
  const double turned_rad = config_.gap_rate_deg_s * kDegree * e.gap_s, pushed_m_s = config_.gap_force_m_s2 * e.gap_s;
  if (!(turned_rad > 0.0 || pushed_m_s > 0.0)) return;
  const double moved_m = 0.5 * pushed_m_s * e.gap_s;
  filter_.loosen(turned_rad, moved_m, pushed_m_s);
  if (!e.done && on_loosened) on_loosened(turned_rad, moved_m, pushed_m_s);
}

void FilterTimeline::predict(const ImuSample& sample, GpsTime to, bool done) {
  if (!done && on_leave) on_leave(filter_);
  const NavState before = filter_.nav_state();
  if (done && observer_ != nullptr) filter_.watch(nullptr);
  filter_.predict(sample);
  if (done && observer_ != nullptr) filter_.watch(observer_);
  at_ = to;
  if (done) return;
  if (on_update)
    for (const UpdateReport& report : filter_.reports()) on_update(report, filter_);
  if (on_step) on_step(sample, before, filter_);
}

/// Brings the filter to the event's time, within the sample that holds it; false while that has not come.
bool FilterTimeline::reach(const Event& e) {
  if (e.t - at_ <= config_.same_instant_s) return true;
  std::int64_t i = next_ + 1;
  while (i < end() && !event(i).moves()) ++i;
  if (i == end()) return false;
  const Event& holds = event(i);
  ImuSample sample = motion_of(holds);
  ImuSample part = take_share(sample, (e.t - at_) / (holds.t - at_));
  part.t.ns = e.t.ns + (holds.own.ns - holds.t.ns);
  rest_ = sample;
  predict(part, e.t, holds.done);
  return true;
}

void FilterTimeline::take(const AidingMessage& message, bool done) {
  const std::size_t before = filter_.reports().size();
  // What the unit's own clock shows now.
  const std::int64_t own_ns = filter_.nav_state().t.ns - at_.ns;
  if (const auto* fix = std::get_if<GnssFix>(&message)) {
    GnssFix by_its_clock = *fix;
    by_its_clock.t.ns += own_ns;
    // What the state time_offset says may have moved while the fix has waited, by more than the filter takes.
    if (std::min(std::abs(fix->t - at_), std::abs(due(message) - at_)) > kMostAge_s) {
      if (!done) incidents_.add(Trouble::kTooLate, fix->t);
      return;
    }
    UpdateReport report = filter_.update(by_its_clock);
    report.t = fix->t;
    if (on_update && !done && (report.dimension > 0 || report.accepted)) on_update(report, filter_);
  } else if (const auto* epoch = std::get_if<GnssEpoch>(&message)) {
    GnssEpoch by_its_clock = *epoch;
    by_its_clock.t.ns += own_ns;
    filter_.update(AidingMessage(by_its_clock));
  } else {
    filter_.update(message);
  }
  if (on_update && !done)
    for (std::size_t i = before; i < filter_.reports().size(); ++i) on_update(filter_.reports()[i], filter_);
}

void FilterTimeline::forget() {
  while (checkpoints_.size() > 1 && reached_ - checkpoints_[1].at >= config_.wait_s) checkpoints_.pop_front();
  for (; first_ < checkpoints_.front().next; ++first_) events_.pop_front();
}

}  // namespace canyon::fusion
