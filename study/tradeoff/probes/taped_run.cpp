#include "canyon/study/tradeoff/probes/taped_run.h"

#include <algorithm>
#include <filesystem>

#include "canyon/mission/run.h"
#include "canyon/study/results/run_statistics.h"

namespace canyon::study {

Result<RunSummary> taped_run(mission::MissionConfig config, const mission::PreparedMission& mission, const Tape& tape,
                             double limit_s, const mission::Omissions* omissions) {
  config.time.limit_s = std::min(limit_s, tape.duration_s());
  RunStatistics statistics(mission.scene->frame(), std::filesystem::temp_directory_path().string());
  CANYON_TRY(
      const mission::RunRecord record,
      mission::run_mission(config, mission, nullptr,
                           {.tape = &tape, .recorder = &statistics, .autonomy = nullptr, .omissions = omissions}));
  return summarize(record, statistics);
}

std::int64_t work_of(const RunSummary& run) {
  std::int64_t work = 0;
  for (const auto& [name, count] : run.counters) work += count;
  return work;
}

}  // namespace canyon::study
