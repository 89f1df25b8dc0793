#include "canyon/study/plan/cost.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"
#include "canyon/study/plan/readers.h"
#include "canyon/study/plan/replay/replay.h"
#include "canyon/study/plan/replay/run_pair.h"

namespace canyon::study {

namespace {

constexpr double kSample_s = 15.0;
constexpr std::int64_t kEpochs = 60;

void set_saved(Plan& plan, const char* effect, double seconds) {
  for (PlannedEffect& line : plan.effects)
    if (line.whole_run() && line.need.effect == effect && line.need.verdict == Verdict::kNotNeeded)
      line.saved_cpu_s = seconds;
}

/// Two measurements of the same, with and without: what is saved by both, and nothing where the clock's own scatter is
/// as large as that.
double saved_s(double full_a, double full_b, double less_a, double less_b) {
  const double saved = std::min(full_a, full_b) - std::min(less_a, less_b);
  const double scatter = std::max(std::abs(full_a - full_b), std::abs(less_a - less_b));
  return saved > scatter ? saved : 0.0;
}

/// CPU time of one epoch.
double seconds_of(GnssReplay& replay, gnss::GnssSensor& sensor, const GnssReplay::Epoch& epoch,
                  const gnss::PathOmissions& leave_out) {
  CpuAccount account;
  {
    const ChargeCpu charge(&account);
    replay.measure(sensor, epoch, leave_out);
  }
  return account.seconds();
}

/// Each line gets what leaving out its effect saves at the epochs that lie on its stretch.
Status measure_gnss(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
                    Plan& plan) {
  const auto& corridor = plan.omissions.corridor;
  GnssReplay replay(config, mission, tape, plan.omissions, kEpochs);
  const double epochs_each = mission.nominal_s * config.gnss.rate_hz / static_cast<double>(kEpochs);
  CANYON_TRY(const auto full, replay.sensor());
  std::vector<double> full_s;
  for (const auto& epoch : replay.epochs()) {
    throw_if_cancelled();
    replay.measure(*full, epoch, {});  // warm, and the indices made
  }
  std::vector<double> again_s;
  for (std::vector<double>* seconds : {&full_s, &again_s}) {
    CANYON_TRY(const auto again, replay.sensor());
    for (const auto& epoch : replay.epochs()) seconds->push_back(seconds_of(replay, *again, epoch, {}));
  }
  for (PlannedEffect& line : plan.effects) {
    if (line.whole_run() || line.need.verdict != Verdict::kNotNeeded) continue;
    CANYON_TRY(const auto sensor, replay.sensor());
    CANYON_TRY(const auto once_more, replay.sensor());
    double with_a = 0.0, with_b = 0.0, without_a = 0.0, without_b = 0.0;
    for (std::size_t k = 0; k < full_s.size(); ++k) {
      throw_if_cancelled();
      const auto& epoch = replay.epochs()[k];
      const bool here = epoch.place < corridor.size() && corridor[epoch.place].segment.start_m >= line.start_m - 1e-6 &&
                        corridor[epoch.place].segment.end_m <= line.end_m + 1e-6;
      if (!here) continue;
      const auto leave_out = only(line.need.effect.c_str(), corridor[epoch.place].paths);
      if (leave_out == gnss::PathOmissions{}) continue;
      with_a += full_s[k];
      with_b += again_s[k];
      without_a += seconds_of(replay, *sensor, epoch, leave_out);
      without_b += seconds_of(replay, *once_more, epoch, leave_out);
    }
    line.saved_cpu_s = epochs_each * saved_s(with_a, with_b, without_a, without_b);
  }
  return Ok{};
}

}  // namespace

Result<PredictedCost> measure_cost(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                   const Tape& tape, Plan& plan) {
  CANYON_TRY_STATUS(drive_pair(config, mission, tape, plan.omissions, 1.0));  // libraries opened, indices made
  CANYON_TRY(const RunPair pair, drive_pair(config, mission, tape, plan.omissions, kSample_s));
  CANYON_TRY(const RunPair again, drive_pair(config, mission, tape, plan.omissions, kSample_s));
  const double scale = mission.nominal_s / std::max(pair.simulated_s, 1e-3);
  const auto saved = [&](mission::Part part) {
    return scale *
           saved_s(pair.full.cpu_s(part), again.full.cpu_s(part), pair.planned.cpu_s(part), again.planned.cpu_s(part));
  };
  set_saved(plan, kRegistration, saved(mission::Part::kRegistration));
  set_saved(plan, kMaps, saved(mission::Part::kScoring));
  set_saved(plan, kKeyframes, 0.0);  // their choice alone; what is made of them has its own lines
  set_saved(plan, kScans, saved(mission::Part::kLidar));
  set_saved(plan, kUnkeptRays, saved(mission::Part::kLidar));
  set_saved(plan, kAutonomy, saved(mission::Part::kAutonomy));
  set_saved(plan, kMovedScene, 0.0);  // a scene in which nothing moves is not made anew anyway
  if (!plan.omissions.corridor.empty()) CANYON_TRY_STATUS(measure_gnss(config, mission, tape, plan));
  return PredictedCost{scale * std::min(pair.full.total_s(), again.full.total_s()),
                       scale * std::min(pair.planned.total_s(), again.planned.total_s())};
}

}  // namespace canyon::study
