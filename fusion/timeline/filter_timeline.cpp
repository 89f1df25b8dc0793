#include "canyon/fusion/timeline/filter_timeline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/fusion/divided_sample.h"

namespace canyon::fusion {
namespace {

/// Instants this close are the same: rounding of stamps.
constexpr double kSame_s = 1e-6;
/// Between copies to go back to, and between the steps of a long gap.
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

FilterTimeline::FilterTimeline(ErrorStateFilter filter, const TimelineConfig& config)
    : filter_(std::move(filter)), config_(config), reached_(filter_.nav_state().t) {
  checkpoints_.push_back({filter_, 0});
}

Trouble FilterTimeline::add(const ImuSample& given) {
  const auto told = [&](Trouble trouble) {
    if (trouble != Trouble::kNone) incidents_.add(trouble, given.t);
    return trouble;
  };
  if (!is_finite(given)) return told(Trouble::kNotFinite);
  const double since_s = given.t - reached_;
  if (std::abs(since_s) <= kSame_s) return told(Trouble::kDuplicate);
  if (since_s < 0.0) return told(Trouble::kReversed);
  ImuSample sample = given;
  Trouble trouble = sample.lost ? Trouble::kLost : Trouble::kNone;
  double gap_s = sample.lost ? sample.dt_s : 0.0;
  const double missing_s = since_s - sample.dt_s;
  if (missing_s > 0.5 * sample.dt_s) {
    trouble = Trouble::kGap;
    bridge(sample.t - sample.dt_s, sample.dt_s, true);
  } else if (missing_s < -0.5 * sample.dt_s) {
    take_share(sample, -missing_s / sample.dt_s);  // what has come before
  }
  last_imu_ = sample;
  reached_ = sample.t;
  // Messages that have waited for it come after it.
  auto at = events_.end();
  while (at != events_.begin() && std::prev(at)->t >= sample.t) --at;
  events_.insert(at, {.t = sample.t, .what = sample, .gap_s = gap_s});
  run();
  return told(trouble);
}

void FilterTimeline::bridge(GpsTime to, double dt_s, bool loosens) {
  const double gap_s = to - reached_;
  GpsTime held_to = reached_;
  held_to.ns += static_cast<std::int64_t>(1e9 * config_.held_s);
  std::vector<Event> parts;
  for (GpsTime t = reached_; to - t > kSame_s;) {
    const bool hold = last_imu_.has_value() && t < held_to;
    const GpsTime from = t;
    const double left_s = to - t, step_s = hold ? dt_s : std::max(dt_s, kApart_s);
    t = left_s < 1.5 * step_s ? to : GpsTime{.ns = t.ns + static_cast<std::int64_t>(std::llround(1e9 * step_s))};
    Event part{.t = t, .what = Coast{t - from}};
    if (hold) {
      ImuSample again = *last_imu_;
      const double share = (t - from) / again.dt_s;
      again.t = t;
      again.dt_s = t - from;
      again.dtheta_U *= share;
      again.dv_U *= share;
      part.what = again;
    }
    parts.push_back(part);
  }
  if (parts.empty()) return;
  if (loosens) parts.back().gap_s = gap_s;
  for (Event& part : parts) {
    auto at = events_.end();
    while (at != events_.begin() && std::prev(at)->t >= part.t) --at;
    events_.insert(at, std::move(part));
  }
}

void FilterTimeline::coast(GpsTime to) {
  if (to - reached_ <= kSame_s) return;
  last_imu_.reset();
  bridge(to, kApart_s, false);
  reached_ = to;
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

Trouble FilterTimeline::add(const AidingMessage& message) {
  const auto* fix = std::get_if<GnssFix>(&message);
  if (fix != nullptr && fix->status == FixStatus::kNone) return Trouble::kNone;
  const auto told = [&](Trouble trouble) {
    if (trouble != Trouble::kNone) incidents_.add(trouble, time_of(message));
    return trouble;
  };
  if (const Trouble trouble = judge(message); trouble != Trouble::kNone) return told(trouble);
  const GpsTime t = due(message);
  std::int64_t at = end();
  while (at > first_ && event(at - 1).t > t) --at;
  if (at < next_ || filter_.nav_state().t - t > kSame_s) {
    if (at < checkpoints_.front().next || checkpoints_.front().filter.nav_state().t - t > kSame_s)
      return told(Trouble::kTooLate);
    go_back(at);
  }
  events_.insert(events_.begin() + (at - first_), {.t = t, .what = message});
  run();
  return told(t - reached_ > kSame_s ? Trouble::kAhead : Trouble::kNone);
}

void FilterTimeline::go_back(std::int64_t to) {
  while (checkpoints_.back().next > to) checkpoints_.pop_back();
  // A copy made within a sample would not know what is left of it: there is none.
  filter_ = checkpoints_.back().filter;
  next_ = checkpoints_.back().next;
  rest_.reset();
  ++replays_;
}

void FilterTimeline::run() {
  while (next_ < end()) {
    Event& e = event(next_);
    if (e.moves())
      move(e);
    else if (!correct(e))
      return;
    e.done = true;
    ++next_;
    if (e.moves() && filter_.nav_state().t - checkpoints_.back().filter.nav_state().t >= kApart_s) {
      checkpoints_.push_back({filter_, next_});
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
  out.t = e.t;
  out.dt_s = dt_s;
  out.dtheta_U = dt_s * (w_U + imu.gyro_gain * w_U + imu.gyro_bias);
  out.dv_U = dt_s * (f_U + imu.accel_gain * f_U + imu.accel_bias);
  return out;
}

void FilterTimeline::move(Event& e) {
  const ImuSample sample = motion_of(e);
  rest_.reset();
  predict(sample, e.done);
  if (e.gap_s > 0.0) {
    const double pushed = config_.gap_force_m_s2 * e.gap_s;
    filter_.loosen(config_.gap_rate_deg_s * kDegree * e.gap_s, 0.5 * pushed * e.gap_s, pushed);
  }
}

void FilterTimeline::predict(const ImuSample& sample, bool done) {
  filter_.predict(sample);
  if (done || !on_update) return;
  for (const UpdateReport& report : filter_.reports()) on_update(report, filter_);
}

bool FilterTimeline::correct(Event& e) {
  const GpsTime now = filter_.nav_state().t;
  if (e.t - now > kSame_s) {
    std::int64_t i = next_ + 1;
    while (i < end() && !event(i).moves()) ++i;
    if (i == end()) return false;  // it waits for the IMU
    ImuSample sample = motion_of(event(i));
    ImuSample part = take_share(sample, (e.t - now) / (sample.t - now));
    part.t = e.t;
    rest_ = sample;
    predict(part, e.done);
  }
  const auto& message = std::get<AidingMessage>(e.what);
  const std::size_t before = filter_.reports().size();
  if (const auto* fix = std::get_if<GnssFix>(&message)) {
    const UpdateReport report = filter_.update(*fix);
    if (on_update && !e.done && report.dimension > 0) on_update(report, filter_);
  } else {
    filter_.update(message);
  }
  if (on_update && !e.done)
    for (std::size_t i = before; i < filter_.reports().size(); ++i) on_update(filter_.reports()[i], filter_);
  return true;
}

void FilterTimeline::forget() {
  while (checkpoints_.size() > 1 && reached_ - checkpoints_[1].filter.nav_state().t >= config_.wait_s)
    checkpoints_.pop_front();
  for (; first_ < checkpoints_.front().next; ++first_) events_.pop_front();
}

}  // namespace canyon::fusion
