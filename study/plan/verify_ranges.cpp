#include "canyon/study/plan/verify_ranges.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/mission/run.h"
#include "canyon/study/plan/replay/replay.h"
#include "canyon/study/plan/replay/run_pair.h"

namespace canyon::study {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// An omission, or all of them, with the promise that goes with it.
struct Asked {
  std::string name;
  gnss::RangeOmissions ranges;
};

std::vector<Asked> asked_of(const Plan& plan) {
  std::vector<Asked> asked;
  for (const PlannedEffect& line : plan.effects) {
    if (line.need.verdict != Verdict::kNotNeeded || !(line.need.bound > 0.0)) continue;
    const auto delays = gnss::delays_of({line.need});
    if (delays == gnss::DelayOmissions{}) continue;
    asked.push_back({line.need.effect, {delays, line.need.bound, plan.omissions.ranges.most_gain}});
  }
  if (asked.size() > 1) asked.push_back({"all that acts by less", plan.omissions.ranges});
  return asked;
}

void count(double difference, double bound, VerifiedEffect& found) {
  found.bound = std::max(found.bound, bound);
  found.largest_difference = std::max(found.largest_difference, difference);
  found.violations += difference <= bound ? 0 : 1;
}

/// What the receiver fits, less what it fits it with, at the true antenna: errors of the range as they act.
double acting_m(const GnssObservation& o, const Eigen::Vector3d& p_A_E) {
  return o.corrected_m() - (o.p_E - p_A_E).norm();
}

/// The largest over the satellites; infinite where others are tracked or used.
double ranges_apart_m(const gnss::GnssOutput& a, const gnss::GnssOutput& b) {
  const auto &of_a = a.epoch.observations, &of_b = b.epoch.observations;
  if (of_a.size() != of_b.size()) return kInfinite;
  double most = 0.0;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (of_a[i].sv != of_b[i].sv || of_a[i].used != of_b[i].used) return kInfinite;
    most = std::max(most, std::abs(acting_m(of_a[i], a.truth.p_A_E) - acting_m(of_b[i], a.truth.p_A_E)));
  }
  return most;
}

double fixes_apart_m(const gnss::GnssOutput& a, const gnss::GnssOutput& b) {
  if (a.fix.status != b.fix.status) return kInfinite;
  return a.fix.status == FixStatus::kNone ? 0.0 : (a.fix.p_A_E - b.fix.p_A_E).norm();
}

Status verify_epochs(GnssReplay& replay, const std::vector<gnss::GnssOutput>& full, const Asked& asked,
                     Verification& verification) {
  VerifiedEffect ranges{.effect = asked.name + ": ranges", .kind = Verified::kRanges, .unit = "m"};
  VerifiedEffect fixes{.effect = asked.name + ": fixes", .kind = Verified::kRanges, .unit = "m", .of_position = true};
  CANYON_TRY(const auto sensor, replay.sensor());
  sensor->leave_out(asked.ranges);
  for (std::size_t k = 0; k < full.size(); ++k) {
    throw_if_cancelled();
    const gnss::GnssOutput output = replay.measure(*sensor, replay.epochs()[k], {});
    ++ranges.replayed, ++ranges.epochs;
    ++fixes.replayed, ++fixes.epochs;
    count(ranges_apart_m(full[k], output), asked.ranges.bound_m, ranges);
    const bool watched = output.range_gain <= asked.ranges.most_gain;
    count(fixes_apart_m(full[k], output), watched ? asked.ranges.bound_m * output.range_gain : 0.0, fixes);
  }
  verification.effects.push_back(std::move(ranges));
  verification.effects.push_back(std::move(fixes));
  return Ok{};
}

/// The plan's bound for the estimate at a time.
double bound_at(const Plan& plan, double t_s) {
  const auto next = std::upper_bound(plan.epoch_t_s.begin(), plan.epoch_t_s.end(), t_s + 1e-6);
  return next == plan.epoch_t_s.begin()
             ? 0.0
             : plan.epoch_bound_m[static_cast<std::size_t>(next - plan.epoch_t_s.begin() - 1)];
}

/// Of runs that show what fixes and steps do to the estimate: nobody looks, nothing is mapped, and the seeds are after
/// those that the bounds were taken from.
mission::MissionConfig fresh(mission::MissionConfig config, const Plan& plan) {
  config.autonomy.model.name = "route_follower";
  config.autonomy.map = mission::MapPose::kPrior;
  config.registration.method.name = "none";
  config.run.withhold_scans_after_s = 0.0;
  config.run.seed += static_cast<std::int64_t>(plan.seeds.size());
  return config;
}

Status verify_runs(mission::MissionConfig config, const mission::PreparedMission& mission, const Tape& tape,
                   const Plan& plan, std::int64_t epochs, Verification& verification) {
  VerifiedEffect found{
      .effect = "all that acts by less: estimates", .kind = Verified::kEstimates, .unit = "m", .of_position = true};
  mission::Omissions only_ranges;
  only_ranges.ranges = plan.omissions.ranges;
  only_ranges.strapdown = plan.omissions.strapdown;
  config = fresh(std::move(config), plan);
  while (found.epochs < epochs) {
    throw_if_cancelled();
    CANYON_TRY(const RunPair pair, drive_pair(config, mission, tape, only_ranges));
    for (const RunPair::Apart& row : pair.apart) {
      ++found.replayed, ++found.epochs;
      count(row.position_m, bound_at(plan, row.t_s), found);
    }
    if (pair.apart.empty()) break;
    ++config.run.seed;
  }
  verification.effects.push_back(std::move(found));
  return Ok{};
}

struct Samples final : mission::Recorder {
  std::vector<ImuSample> all;
  Status imu(const ImuSample& sample) override {
    all.push_back(sample);
    return Ok{};
  }
};

/// How far apart the attitudes are that two integrators come to, rad, at its most.
double attitudes_apart_rad(const std::vector<ImuSample>& samples, const fusion::NavState& start,
                           const std::string& integrator, const fusion::StrapdownOmissions& leave_out) {
  const auto full = fusion::make_strapdown(integrator), less = fusion::make_strapdown(integrator);
  less->leave_out(leave_out);
  fusion::NavState a = start, b = start;
  double most_rad = 0.0;
  for (const ImuSample& sample : samples) {
    const fusion::Increments in{.dt_s = sample.dt_s, .dtheta_U = sample.dtheta_U, .dv_U = sample.dv_U};
    full->advance(a, in);
    less->advance(b, in);
    most_rad = std::max(most_rad, so3_log(a.R_EU.conjugate() * b.R_EU).norm());
  }
  return most_rad;
}

/// Free integrations of what the unit measures, in runs of seeds of their own; counted are the rows of estimates of the
/// runs.
Status verify_attitudes(mission::MissionConfig config, const mission::PreparedMission& mission, const Tape& tape,
                        const Plan& plan, std::int64_t epochs, Verification& verification) {
  std::vector<VerifiedEffect> found;
  std::vector<Need> needs;
  for (const PlannedEffect& line : plan.effects) {
    if (!fusion::strapdown_omissions_of({line.need}).any()) continue;
    needs.push_back(line.need);
    found.push_back({.effect = line.need.effect + ": attitude",
                     .kind = Verified::kEstimates,
                     .unit = line.need.bound_unit,
                     .bound = line.need.bound});
  }
  config = fresh(std::move(config), plan);
  const LocalFrame& frame = mission.scene->frame();
  while (!found.empty() && found.front().epochs < epochs) {
    throw_if_cancelled();
    Samples samples;
    CANYON_TRY(const auto run, mission::run_mission(config, mission, nullptr,
                                                    {.tape = &tape, .recorder = &samples, .autonomy = nullptr}));
    if (samples.all.empty() || tape.duration_s() * config.run.epoch_rate_hz < 1.0) break;
    const fusion::NavState start{.t = mission.start,
                                 .R_EU = Eigen::Quaterniond(frame.R_EW()) * run.initial_X_WB.R,
                                 .p_EU_E = frame.to_E(run.initial_X_WB.p),
                                 .v_EU_E = frame.R_EW() * run.initial_v_WB_W};
    const double time_s = samples.all.back().t - mission.start;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double apart_rad =
          attitudes_apart_rad(samples.all, start, config.fusion.integrator, fusion::strapdown_omissions_of({needs[i]}));
      found[i].replayed += static_cast<std::int64_t>(time_s * config.run.epoch_rate_hz);
      found[i].epochs = found[i].replayed;
      count(apart_rad / time_s * 3600.0 / kDegree, needs[i].bound, found[i]);
    }
    ++config.run.seed;
  }
  for (VerifiedEffect& effect : found) verification.effects.push_back(std::move(effect));
  return Ok{};
}

}  // namespace

Status verify_ranges(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
                     const Plan& plan, std::int64_t epochs, Verification& verification) {
  if (!plan.omissions.moves()) return Ok{};
  CANYON_TRY_STATUS(verify_attitudes(config, mission, tape, plan, epochs, verification));
  const std::vector<Asked> asked = asked_of(plan);
  GnssReplay replay(config, mission, tape, plan.omissions, epochs);
  CANYON_TRY(const auto sensor, replay.sensor());
  std::vector<gnss::GnssOutput> full;
  for (const GnssReplay::Epoch& epoch : replay.epochs()) {
    throw_if_cancelled();
    if (!asked.empty()) full.push_back(replay.measure(*sensor, epoch, {}));
  }
  for (const Asked& one : asked) CANYON_TRY_STATUS(verify_epochs(replay, full, one, verification));
  return verify_runs(config, mission, tape, plan, epochs, verification);
}

}  // namespace canyon::study
