#include "canyon/study/fuse/run.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/fusion/alignment/alignment.h"
#include "canyon/fusion/divided_sample.h"
#include "canyon/fusion/reference_track.h"
#include "canyon/fusion/verdict/state_record.h"

namespace canyon::study {
namespace {

constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

/// What waits for its time. Of one time the order of `kind` holds.
struct Message {
  enum Kind { kOdometer, kHeading, kBarometer, kMagnetometer, kMapPose, kFix, kRanges, kEpoch };
  GpsTime came;
  Kind kind;
  std::size_t index;
};

std::vector<Message> messages_of(const FuseInputs& in, const FusePlan& plan) {
  std::vector<Message> out;
  const auto add = [&out](const auto& all, Message::Kind kind) {
    for (std::size_t i = 0; i < all.size(); ++i) out.push_back({all[i].t, kind, i});
  };
  add(in.odometer, Message::kOdometer);
  add(in.heading, Message::kHeading);
  add(in.barometer, Message::kBarometer);
  add(in.magnetometer, Message::kMagnetometer);
  add(in.poses, Message::kMapPose);
  for (std::size_t i = 0; i < in.fixes.size(); ++i)
    out.push_back({in.fixes_came.empty() ? in.fixes[i].t : in.fixes_came[i], Message::kFix, i});
  if (fusion::measures_with(plan.filter, "ranges"))
    for (std::size_t i = 0; i < in.ranges.size(); ++i) out.push_back({in.ranges[i].due, Message::kRanges, i});
  for (std::size_t i = 0; i < plan.epochs.size(); ++i) out.push_back({plan.epochs[i], Message::kEpoch, i});
  std::stable_sort(out.begin(), out.end(), [](const Message& a, const Message& b) {
    return a.came != b.came ? a.came < b.came : a.kind < b.kind;
  });
  return out;
}

/// How far the fixes that the filter is given are off, where the reference says where the antenna was.
void tell_fix_errors(const FuseInputs& in, const FusePlan& plan, fusion::RunEvidence& evidence) {
  const Eigen::Vector3d point = in.truth.of == TruthPoint::kAntenna ? plan.lever_A_B
                                : in.truth.of == TruthPoint::kImu   ? plan.lever_U_B
                                                                    : Eigen::Vector3d::Zero().eval();
  const Eigen::Vector3d arm = plan.lever_A_B - point;
  if (!in.truth.has_attitude && !arm.isZero()) return;
  for (const GnssFix& fix : in.fixes) {
    if (fix.t - plan.start < plan.skip_s) continue;
    const auto truth = fusion::reference_at(in.truth.states, fix.t);
    if (truth) evidence.fix(fix.t, fix.p_A_E - truth->p_EU_E - truth->R_EU * arm, fix.covariance_E);
  }
}

class Run {
 public:
  Run(const FuseInputs& in, const FusePlan& plan)
      : in_(in),
        plan_(plan),
        messages_(messages_of(in, plan)),
        outages_(plan.outages ? Outages(*plan.outages, in.begin(), in.end()) : Outages()),
        scorer_(in.truth, plan.lever_U_B, plan.lever_A_B, plan.start + plan.skip_s, evidence_) {}
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  Result<Fused> all();

 private:
  void begin(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W);
  void end();
  bool restart(std::size_t k);
  void take(ImuSample sample, GpsTime due);
  void give(const Message& message);
  void give(const GnssFix& fix);
  void give(const DueRanges& ranges);
  void keep(const fusion::ErrorStateFilter& filter);
  void note(const fusion::UpdateReport& report);
  void settle(const fusion::ErrorStateFilter& filter);
  void stepped(const ImuSample& sample, const fusion::NavState& before, const fusion::ErrorStateFilter& filter);
  void keep_parameters();
  /// By the clock of the messages.
  fusion::NavState stamped(fusion::NavState state, GpsTime t) const {
    state.t = t;
    return state;
  }

  const FuseInputs& in_;
  const FusePlan& plan_;
  std::vector<Message> messages_;
  fusion::RunEvidence evidence_;
  std::optional<fusion::FilterTimeline> timeline_;
  Outages outages_;
  Scorer scorer_;
  Fused out_;
  std::size_t next_ = 0;  ///< message
  GpsTime left_, next_epoch_;
  bool has_last_ = false;
  Eigen::Vector3d rate_U_ = Eigen::Vector3d::Zero();
  Eigen::VectorXd start_variances_;
};

void Run::begin(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W) {
  fusion::ErrorStateFilter filter(plan_.filter, plan_.noise, plan_.frame, plan_.lever_U_B, plan_.lever_A_B);
  filter.initialize(t, X_WB, v_WB_W);
  fusion::PredictionAlone& alone = evidence_.follow(filter);
  timeline_.emplace(std::move(filter), plan_.timeline);
  timeline_->watch(&alone);
  timeline_->on_update = [this](const fusion::UpdateReport& report, const auto&) { note(report); };
  timeline_->on_leave = [this](const auto& now) { settle(now); };
  timeline_->on_step = [this](const auto& sample, const auto& before, const auto& now) {
    stepped(sample, before, now);
  };
  if (plan_.keep_segments) {
    out_.segments.push_back({.start = t, .X_WB = X_WB, .v_WB_W = v_WB_W, .steps = {}, .fixes = {}, .loosened = {}});
    timeline_->on_loosened = [this](double theta_rad, double p_m, double v_m_s) {
      out_.segments.back().loosened.push_back({timeline_->at(), theta_rad, p_m, v_m_s});
    };
  }
  timeline_->on_look = [this](const auto& now) { keep(now); };
  next_epoch_ = t;
  has_last_ = false;
  for (; next_ < messages_.size() && messages_[next_].came <= t; ++next_) ++out_.messages_outside;
}

/// Of what the filter has been through since begin().
void Run::end() {
  settle(timeline_->filter());
  out_.incidents.add(timeline_->incidents());
  out_.bridged_s += timeline_->bridged_s();
  out_.replays += timeline_->replays();
  out_.messages_outside += timeline_->waiting();
}

void Run::note(const fusion::UpdateReport& report) {
  const bool of_fix = report.dimension == 0 || std::string_view(report.measurement) == "position";
  out_.fixes_accepted += of_fix && report.accepted ? 1 : 0;
  const bool counts = report.t - plan_.start >= plan_.skip_s;
  if (report.dimension > 0) {
    MeasurementScore& score = out_.by_measurement[report.measurement];
    ++score.count;
    score.accepted += report.accepted ? 1 : 0;
    if (counts) {
      score.nis_sum += report.nis;
      score.dimensions += report.dimension;
    }
  }
  if (counts) evidence_.innovation(report);
  out_.updates.push_back(report);
}

void Run::give(const GnssFix& fix) {
  if (outages_.withholds(fix.t)) {
    ++out_.fixes_withheld;
    return;
  }
  const fusion::Trouble trouble = timeline_->add(fusion::AidingMessage(fix));
  if (trouble != fusion::Trouble::kNone && trouble != fusion::Trouble::kAhead) return;
  ++out_.fixes_given;
  if (plan_.keep_segments) out_.segments.back().fixes.push_back(fix);
}

void Run::give(const DueRanges& ranges) {
  if (!outages_.withholds(ranges.due)) timeline_->add(fusion::AidingMessage(ranges.epoch), ranges.due);
}

void Run::give(const Message& message) {
  const auto add = [this](const auto& sample) { timeline_->add(fusion::AidingMessage(sample)); };
  switch (message.kind) {
    case Message::kOdometer:
      return add(in_.odometer[message.index]);
    case Message::kHeading:
      return add(in_.heading[message.index]);
    case Message::kBarometer:
      return add(in_.barometer[message.index]);
    case Message::kMagnetometer:
      return add(in_.magnetometer[message.index]);
    case Message::kMapPose:
      return add(pose_in_frame(in_.poses[message.index], plan_.frame));
    case Message::kFix:
      return give(in_.fixes[message.index]);
    case Message::kRanges:
      return give(in_.ranges[message.index]);
    case Message::kEpoch:
      return timeline_->look(plan_.epochs[message.index]);
  }
}

void Run::keep(const fusion::ErrorStateFilter& filter) {
  FuseEpoch epoch;
  epoch.nav = stamped(filter.nav_state(), timeline_->at());
  epoch.estimate = filter.estimate();
  epoch.estimate.t = epoch.nav.t;
  const Eigen::Matrix3d R_WE = plan_.frame.R_EW().transpose();
  Eigen::Matrix<double, 9, 9> J = Eigen::Matrix<double, 9, 9>::Identity();
  J.block<3, 3>(3, 3) = J.block<3, 3>(6, 6) = R_WE;
  epoch.covariance = J * filter.covariance().topLeftCorner<9, 9>() * J.transpose();
  out_.epochs.push_back(epoch);
}

void Run::keep_parameters() {
  const fusion::ErrorStateFilter& filter = timeline_->filter();
  const auto names = fusion::state_names(filter.state());
  const Eigen::VectorXd variances = filter.covariance().diagonal();
  for (int i = fusion::ErrorIndex::kMoving; i < filter.state().size(); ++i)
    out_.parameters.push_back({names[static_cast<std::size_t>(i)].name, filter.value(i), std::sqrt(variances[i]),
                               std::sqrt(start_variances_[i])});
}

void Run::settle(const fusion::ErrorStateFilter& filter) {
  left_ = timeline_->at();
  scorer_.settled(stamped(filter.nav_state(), left_), filter, rate_U_, outages_);
  evidence_.look(filter);  // from the start on: what is observed is often observed at once
}

void Run::stepped(const ImuSample& sample, const fusion::NavState& before, const fusion::ErrorStateFilter& filter) {
  const fusion::Increments in = filter.calibration().apply(sample.dt_s, sample.dtheta_U, sample.dv_U);
  const fusion::NavState after = stamped(filter.nav_state(), timeline_->at());
  rate_U_ = in.dtheta_U / in.dt_s - after.R_EU.conjugate() * earth_rate_E();
  scorer_.passed(stamped(before, left_), after, filter, rate_U_, outages_);
  if (!plan_.keep_segments) return;
  out_.segments.back().steps.push_back(sample);
  out_.segments.back().steps.back().t = after.t;
}

void Run::take(ImuSample sample, GpsTime due) {
  const double same = plan_.timeline.same_instant_s;
  for (; next_ < messages_.size() && messages_[next_].came - due <= same; ++next_) give(messages_[next_]);
  timeline_->add(sample, due);
  if (plan_.rate_hz > 0.0 && due - next_epoch_ >= -same) {
    keep(timeline_->filter());
    while (next_epoch_ - due <= same) next_epoch_ = next_epoch_ + 1.0 / plan_.rate_hz;
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
  end();
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
  tell_fix_errors(in_, plan_, evidence_);
  begin(plan_.start, plan_.X_WB, plan_.v_WB_W);
  start_variances_ = timeline_->filter().covariance().diagonal();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    ImuSample sample = samples[k];
    const GpsTime due = plan_.due.empty() ? sample.t : plan_.due[k];
    if (!has_last_ && due - timeline_->at() <= plan_.timeline.same_instant_s) continue;  // before the start
    const double apart_s = due - timeline_->at() - sample.dt_s;
    if (!has_last_ && apart_s < 0.0) fusion::take_share(sample, -apart_s / sample.dt_s);
    if (apart_s > std::max(plan_.bridge_s, 0.5 * sample.dt_s) && plan_.realign != nullptr && restart(k)) {
      --k;
      continue;
    }
    take(sample, due);
    has_last_ = true;
    ++out_.samples;
    if (!timeline_->filter().nav_state().p_EU_E.allFinite())
      return Error{in_.imu.path, 0, "", "the estimate is no number any more at " + due.iso(), "", 1};
  }
  end();
  out_.messages_outside += messages_.size() - next_;
  out_.gaps_bridged = static_cast<std::size_t>(out_.incidents.count(fusion::Trouble::kGap));
  out_.end = timeline_->at();
  keep_parameters();
  out_.errors = scorer_.errors();
  out_.windows = outages_.windows();
  out_.verdict = evidence_.numbers();
  for (FuseSegment& segment : out_.segments)
    std::stable_sort(segment.fixes.begin(), segment.fixes.end(),
                     [](const GnssFix& a, const GnssFix& b) { return a.t < b.t; });
  return std::move(out_);
}

}  // namespace

Result<Fused> fuse(const FuseInputs& inputs, const FusePlan& plan) {
  return Run(inputs, plan).all();
}

}  // namespace canyon::study
