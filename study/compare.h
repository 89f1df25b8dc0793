#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/result.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/plan/plan.h"
#include "canyon/study/results/results.h"

namespace canyon::study {

/// One run of a comparison: whose GNSS and whose IMU, and with which filter.
struct RunPlan {
  std::string name;  ///< "low", "high_gnss_low_imu", "high_vehicle"
  std::string gnss, imu;
  std::string filter;  ///< row of fusion::filter_sets() with nothing beside it; empty: as the fidelity has it
};

/// One run per fidelity; with `two_by_two` also the mixed runs of the first two, of which there must then be two. With
/// `filters` each of them with each filter, which is then the last part of its name.
std::vector<RunPlan> plan_runs(const std::vector<std::string>& fidelities, bool two_by_two,
                               const std::vector<std::string>& filters = {});

/// A comparison that has been read and checked; nothing has been driven yet.
struct Comparison {
  std::vector<RunPlan> plan;
  std::vector<mission::MissionConfig> configs;     ///< same index
  std::vector<mission::PreparedMission> missions;  ///< same index; equal scenes are shared
  std::vector<Plan> plans;   ///< same index: what each run leaves out; empty: nothing. `configs` are without it
  std::optional<Tape> tape;  ///< all runs on this true motion (open loop); none: each drives by itself (closed loop)
};

/// What an open loop runs on. With neither path: the mission's own route, driven on truth.
struct TapeChoice {
  std::string tape;        ///< a tape file, or a results directory that holds one
  std::string trajectory;  ///< a trajectory file
  double trajectory_rate_hz = 10.0;
};
/// Finds or drives the tape and checks that it fits every run's mission.
Status choose_tape(const TapeChoice& choice, Comparison& comparison);

/// What run i leaves out.
const mission::Omissions* omissions(const Comparison& comparison, std::size_t i);

/// Every mistake of the mission file is found here, before any time is spent.
Result<Comparison> prepare_comparison(const mission::MissionFile& file, const std::vector<RunPlan>& plan);

/// Drives all runs, each on one thread, side by side; the same seed and so the same random numbers in all. Each writes
/// its epochs, clouds and tape into `directory` as it goes (study/results/results.h writes the rest); with an empty one
/// there are the figures alone. The returned Results point into `comparison`, which must outlive them.
Result<Results> compare(const Comparison& comparison, const std::string& directory, bool show_progress);

/// Closed and open loop side by side, for a terminal: what each shows, and two columns per run, of the figures with
/// these keys or of those that both have; over several seeds medians. `results` must have both.
std::string both_loops_table(const Results& results, const std::vector<std::string>& keys = {});

/// The terminal table: one column per run, and the ratio of the second to the first; of the figures with these keys
/// (study/results/figures.h), which must be known, or of all.
std::string comparison_table(const Results& results, const std::vector<std::string>& keys = {});

}  // namespace canyon::study
