#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/core/result.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/recorder/run_record.h"
#include "canyon/study/plan/plan.h"
#include "canyon/study/results/paired_errors.h"
#include "canyon/study/results/summary.h"

namespace canyon::study {

/// The same runs on one true motion, beside closed loops: their figures alone.
struct OpenLoopRuns {
  std::string tape_source;
  double duration_s = 0.0;
  std::vector<std::vector<RunSummary>> by_seed;  ///< [seed][run], the mixed runs not among them
  std::vector<PairedErrors> paired;              ///< every run against the first, of the first seed
  std::vector<std::string> warnings;             ///< of the first seed's runs
  double wall_s = 0.0;
};

/// What a results directory is made from (docs/results.md).
struct Results {
  const mission::PreparedMission* mission = nullptr;  ///< scene, route and limits shared by the runs
  std::string tape_source;                            ///< what an open loop ran on
  std::vector<mission::RunRecord> records;
  std::vector<RunSummary> summaries;  ///< same index
  std::vector<PairedErrors> paired;   ///< every run against the first; of open loops alone
  /// The same runs with the seeds that follow, one element per seed: summaries are all that is kept of them.
  std::vector<std::vector<RunSummary>> further_seeds;
  std::optional<OpenLoopRuns> open_loop;  ///< where both loops were asked for
  std::vector<Plan> plans;                ///< by run: what it left out; empty: no run left anything out
  double wall_s = 0.0;
  double peak_memory_mb = 0.0;  ///< of the process, when the last run had ended
  int threads = 0;
  std::string command_line;  ///< that asked for it; empty: not known
  std::string commit;        ///< of the source that the program was built from; empty: not known
};

/// One element of summary.json's `runs`.
nlohmann::ordered_json run_json(const RunSummary& summary);
/// The whole of summary.json but its hash.
nlohmann::ordered_json summary_json(const Results& results);

/// The largest resident memory of the process so far.
double peak_memory_mb();

/// Writes summary.json, manifest.json and scene.json beside the epochs/ and clouds/ that the runs' recorders have
/// written (mission/recorder/run_files.h); returns the hash over all.
Result<std::string> write_results(const std::string& directory, const Results& results);

/// The scene from above, for drawing.
nlohmann::ordered_json scene_json(const scene::Scene& scene);

}  // namespace canyon::study
