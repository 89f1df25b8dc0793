#include "canyon/study/fuse/run.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/fusion/alignment/alignment.h"
#include "canyon/fusion/divided_sample.h"

namespace canyon::study {
namespace {

constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

/// What waits for its time. Of one time the order of `kind` holds.
struct Message {
  enum Kind { kOdometer, kFix, kEpoch };
  GpsTime t;
  Kind kind;
  std::size_t index;
};

std::vector<Message> messages_of(const FuseInputs& in, const FusePlan& plan) {
  std::vector<Message> out;
  for (std::size_t i = 0; i < in.odometer.size(); ++i) out.push_back({in.odometer[i].t, Message::kOdometer, i});
  for (std::size_t i = 0; i < in.fixes.size(); ++i) out.push_back({in.fixes[i].t, Message::kFix, i});
  for (std::size_t i = 0; i < plan.epochs.size(); ++i) out.push_back({plan.epochs[i], Message::kEpoch, i});
  std::stable_sort(out.begin(), out.end(),
                   [](const Message& a, const Message& b) { return a.t != b.t ? a.t < b.t : a.kind < b.kind; });
  return out;
}

class Run {
 public:
  Run(const FuseInputs& in, const FusePlan& plan)
      : in_(in),
        plan_(plan),
        messages_(messages_of(in, plan)),
        filter_(plan.filter, plan.noise, plan.frame, plan.lever_U_B, plan.lever_A_B),
        outages_(plan.outages ? Outages(*plan.outages, in.begin(), in.end()) : Outages()),
        scorer_(in.truth, plan.lever_U_B, plan.lever_A_B, plan.start + plan.skip_s) {}

  Result<Fused> all();

 private:
  void begin(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W);
  bool restart(std::size_t k);
  void bridge(GpsTime until);
  void take(ImuSample sample, GpsTime due);
  void predict(const ImuSample& sample, GpsTime due);
  void give(const Message& message);
  void give(GnssFix fix);
  void keep();
  void note(const fusion::UpdateReport& report);
  void note_new_reports();
  void settle();

  const FuseInputs& in_;
  const FusePlan& plan_;
  std::vector<Message> messages_;
  fusion::ErrorStateFilter filter_;
  Outages outages_;
  Scorer scorer_;
  Fused out_;
  std::size_t next_ = 0;          ///< message
  std::size_t reports_seen_ = 0;  ///< of the filter's, since its last predict()
  GpsTime at_, next_epoch_;
  ImuSample last_;
  bool has_last_ = false;
  Eigen::Vector3d rate_U_ = Eigen::Vector3d::Zero();
};

void Run::begin(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W) {
  filter_.initialize(t, X_WB, v_WB_W);
  at_ = next_epoch_ = t;
  reports_seen_ = 0;
  has_last_ = false;
  for (; next_ < messages_.size() && messages_[next_].t <= t; ++next_) ++out_.messages_outside;
}

void Run::note(const fusion::UpdateReport& report) {
  if (report.dimension > 0) {
    MeasurementScore& score = out_.by_measurement[report.measurement];
    ++score.count;
    score.accepted += report.accepted ? 1 : 0;
    if (report.t - plan_.start >= plan_.skip_s) {
      score.nis_sum += report.nis;
      score.dimensions += report.dimension;
    }
  }
  out_.updates.push_back(report);
}

void Run::note_new_reports() {
  const auto& reports = filter_.reports();
  for (; reports_seen_ < reports.size(); ++reports_seen_) note(reports[reports_seen_]);
}

void Run::give(GnssFix fix) {
  if (outages_.withholds(fix.t)) {
    ++out_.fixes_withheld;
    return;
  }
  // The unit's own clock, which nobody sets, may be any time off.
  fix.t.ns += filter_.nav_state().t.ns - at_.ns;
  ++out_.fixes_given;
  const fusion::UpdateReport report = filter_.update(fix);
  out_.fixes_accepted += report.accepted ? 1 : 0;
  note(report);
}

void Run::give(const Message& message) {
  switch (message.kind) {
    case Message::kOdometer:
      filter_.update(fusion::AidingMessage(in_.odometer[message.index]));
      break;
    case Message::kFix:
      give(in_.fixes[message.index]);
      break;
    case Message::kEpoch:
      keep();
      break;
  }
  note_new_reports();
}

void Run::keep() {
  FuseEpoch epoch;
  epoch.nav = filter_.nav_state();
  epoch.nav.t = at_;
  epoch.estimate = filter_.estimate();
  epoch.estimate.t = at_;
  const Eigen::Matrix3d R_WE = plan_.frame.R_EW().transpose();
  Eigen::Matrix<double, 9, 9> J = Eigen::Matrix<double, 9, 9>::Identity();
  J.block<3, 3>(3, 3) = J.block<3, 3>(6, 6) = R_WE;
  epoch.covariance = J * filter_.covariance().topLeftCorner<9, 9>() * J.transpose();
  out_.epochs.push_back(epoch);
}

void Run::settle() {
  scorer_.settled(filter_, rate_U_, outages_);
}

void Run::predict(const ImuSample& sample, GpsTime due) {
  settle();
  const fusion::NavState before = filter_.nav_state();
  filter_.predict(sample);
  reports_seen_ = 0;
  note_new_reports();
  at_ = due;
  const fusion::Increments in = filter_.calibration().apply(sample.dt_s, sample.dtheta_U, sample.dv_U);
  const fusion::NavState& after = filter_.nav_state();
  rate_U_ = in.dtheta_U / in.dt_s - after.R_EU.conjugate() * earth_rate_E();
  scorer_.passed(before, after, filter_, rate_U_, outages_);
}

void Run::take(ImuSample sample, GpsTime due) {
  const double same = plan_.same_instant_s;
  for (; next_ < messages_.size() && messages_[next_].t - due < -same; ++next_) {
    const GpsTime t = messages_[next_].t;
    if (t - at_ > same) predict(fusion::take_share(sample, (t - at_) / (due - at_)), t);
    give(messages_[next_]);
  }
  predict(sample, due);
  for (; next_ < messages_.size() && messages_[next_].t - due <= same; ++next_) give(messages_[next_]);
  if (plan_.rate_hz > 0.0 && due - next_epoch_ >= -plan_.same_instant_s) {
    keep();
    while (next_epoch_ - due <= plan_.same_instant_s) next_epoch_ = next_epoch_ + 1.0 / plan_.rate_hz;
  }
}

/// The last sample again and again, the last of them as long as is left.
void Run::bridge(GpsTime until) {
  ++out_.gaps_bridged;
  out_.bridged_s += until - at_;
  while (until - at_ > plan_.same_instant_s) {
    const double left_s = until - at_;
    ImuSample sample = last_;
    const double dt_s = left_s < 1.5 * last_.dt_s ? left_s : last_.dt_s;
    const double share = dt_s / last_.dt_s;
    sample.dt_s = dt_s;
    sample.dtheta_U *= share;
    sample.dv_U *= share;
    sample.lost = true;
    sample.t = filter_.nav_state().t + dt_s;
    take(sample, left_s < 1.5 * last_.dt_s ? until : at_ + dt_s);
  }
}

/// Aligns anew on what comes from sample k on. False where that cannot be done.
bool Run::restart(std::size_t k) {
  const std::span<const ImuSample> samples = std::span(in_.imu.samples).subspan(k);
  const auto first = std::lower_bound(in_.fixes.begin(), in_.fixes.end(), samples.front().t,
                                      [](const GnssFix& fix, GpsTime t) { return fix.t < t; });
  const auto aligned = fusion::align_in_motion(plan_.realign->start.own, {.imu = samples,
                                                                          .fixes = {first, in_.fixes.end()},
                                                                          .noise = plan_.noise,
                                                                          .lever_U_B = plan_.lever_U_B,
                                                                          .lever_A_B = plan_.lever_A_B});
  if (!aligned) return false;
  settle();
  const Eigen::Matrix3d R_WE = plan_.frame.R_EW().transpose();
  const Eigen::Quaterniond R_WB = (Eigen::Quaterniond(R_WE) * aligned->nav.R_EU).normalized();
  begin(aligned->nav.t, {R_WB, plan_.frame.to_W(aligned->nav.p_EU_E) - R_WB * plan_.lever_U_B},
        R_WE * aligned->nav.v_EU_E);
  ++out_.restarts;
  return true;
}

Result<Fused> Run::all() {
  const std::vector<ImuSample>& samples = in_.imu.samples;
  CANYON_CHECK(plan_.due.empty() || plan_.due.size() == samples.size(), plan_.due.size(), " times of ", samples.size());
  out_.start_from = plan_.start_from;
  out_.start = plan_.start;
  out_.frame = plan_.frame;
  const fusion::FilterParts parts = fusion::filter_parts(plan_.filter);
  out_.states = parts.states;
  out_.measurements = parts.measurements;
  begin(plan_.start, plan_.X_WB, plan_.v_WB_W);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    ImuSample sample = samples[k];
    const GpsTime due = plan_.due.empty() ? sample.t : plan_.due[k];
    if (due - at_ <= plan_.same_instant_s) continue;
    const double apart_s = due - at_ - sample.dt_s, most_s = 0.5 * std::min(sample.dt_s, plan_.interval_s);
    if (!has_last_) last_ = sample;
    if (apart_s < -most_s || (!has_last_ && apart_s < 0.0)) {
      fusion::take_share(sample, -apart_s / sample.dt_s);  // what is before the start is not of it
    } else if (apart_s > most_s) {
      if (apart_s > plan_.bridge_s && plan_.realign != nullptr && restart(k)) {
        --k;
        continue;
      }
      bridge(due - sample.dt_s);
    }
    take(sample, due);
    last_ = samples[k];
    has_last_ = true;
    ++out_.samples;
    if (!filter_.nav_state().p_EU_E.allFinite())
      return Error{in_.imu.path, 0, "", "the estimate is no number any more at " + due.iso(), "", 1};
  }
  settle();
  out_.messages_outside += messages_.size() - next_;
  out_.end = at_;
  out_.errors = scorer_.errors();
  out_.windows = outages_.windows();
  return std::move(out_);
}

}  // namespace

Result<Fused> fuse(const FuseInputs& inputs, const FusePlan& plan) {
  return Run(inputs, plan).all();
}

}  // namespace canyon::study
