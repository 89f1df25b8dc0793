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
      line.saved_cpu_s = std::max(seconds, 0.0);
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
  CANYON_TRY(const auto again, replay.sensor());
  for (const auto& epoch : replay.epochs()) full_s.push_back(seconds_of(replay, *again, epoch, {}));
  for (PlannedEffect& line : plan.effects) {
    if (line.whole_run() || line.need.verdict != Verdict::kNotNeeded) continue;
    CANYON_TRY(const auto sensor, replay.sensor());
    double saved_s = 0.0;
    for (std::size_t k = 0; k < full_s.size(); ++k) {
      throw_if_cancelled();
      const auto& epoch = replay.epochs()[k];
      const bool here = epoch.place < corridor.size() && corridor[epoch.place].segment.start_m >= line.start_m - 1e-6 &&
                        corridor[epoch.place].segment.end_m <= line.end_m + 1e-6;
      if (!here) continue;
      const auto leave_out = only(line.need.effect.c_str(), corridor[epoch.place].paths);
      if (leave_out != gnss::PathOmissions{}) saved_s += full_s[k] - seconds_of(replay, *sensor, epoch, leave_out);
    }
    line.saved_cpu_s = std::max(0.0, saved_s * epochs_each);
  }
  return Ok{};
}

}  // namespace

Result<PredictedCost> measure_cost(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                   const Tape& tape, Plan& plan) {
  CANYON_TRY_STATUS(drive_pair(config, mission, tape, plan.omissions, 1.0));  // libraries opened, indices made
  CANYON_TRY(const RunPair pair, drive_pair(config, mission, tape, plan.omissions, kSample_s));
  const double scale = mission.nominal_s / std::max(pair.simulated_s, 1e-3);
  const auto saved_s = [&](mission::Part part) { return scale * (pair.full.cpu_s(part) - pair.planned.cpu_s(part)); };
  set_saved(plan, kRegistration, saved_s(mission::Part::kRegistration));
  set_saved(plan, kMaps, saved_s(mission::Part::kScoring));
  set_saved(plan, kKeyframes, 0.0);  // their choice alone; what is made of them has its own lines
  set_saved(plan, kScans, saved_s(mission::Part::kLidar));
  set_saved(plan, kUnkeptRays, saved_s(mission::Part::kLidar));
  set_saved(plan, kAutonomy, saved_s(mission::Part::kAutonomy));
  set_saved(plan, kMovedScene, 0.0);  // a scene in which nothing moves is not made anew anyway
  if (!plan.omissions.corridor.empty()) CANYON_TRY_STATUS(measure_gnss(config, mission, tape, plan));
  return PredictedCost{scale * pair.full.total_s(), scale * pair.planned.total_s()};
}

}  // namespace canyon::study
