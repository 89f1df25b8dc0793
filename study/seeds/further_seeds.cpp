#include "canyon/study/seeds/further_seeds.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/run.h"

namespace canyon::study {

namespace {

Result<RunSummary> drive(const Comparison& comparison, std::size_t run, std::int64_t further,
                         const std::string& scratch, Progress& progress) {
  mission::MissionConfig config = comparison.configs[run];
  config.run.seed += further;
  config.run.record_tape = false;  // nobody keeps it
  const mission::PreparedMission& mission = comparison.missions[run];
  RunStatistics statistics(mission.scene->frame(), scratch);
  CANYON_TRY(auto record, mission::run_mission(config, mission, &progress,
                                               {.tape = comparison.tape ? &*comparison.tape : nullptr,
                                                .recorder = &statistics,
                                                .autonomy = nullptr,
                                                .omissions = omissions(comparison, run)}));
  record.name = comparison.plan[run].name;
  record.gnss = comparison.plan[run].gnss;
  record.imu = comparison.plan[run].imu;
  CANYON_TRY(RunSummary summary, summarize(record, statistics));
  summary.evidence.reset();  // hundreds of runs are kept
  return summary;
}

}  // namespace

Status check_seeds(const Comparison& comparison, std::int64_t seeds) {
  const std::int64_t first = comparison.configs.front().run.seed;
  if (first > kLargestSeed - (seeds - 1))
    return Error{.file = "--seeds",
                 .what = std::to_string(seeds) + " seeds from " + std::to_string(first) + " on",
                 .expected = "none beyond " + std::to_string(kLargestSeed)};
  return Ok{};
}

Status add_further_seeds(const Comparison& comparison, std::int64_t count, const std::string& scratch,
                         bool show_progress, Results& results) {
  const auto wall_start = std::chrono::steady_clock::now();
  const std::size_t runs = comparison.plan.size(), total = runs * static_cast<std::size_t>(count);
  double seed_s = 0.0;
  for (const auto& mission : comparison.missions)
    seed_s += comparison.tape ? comparison.tape->duration_s() : std::min(mission.nominal_s, mission.time_limit_s);
  Progress progress("driving " + std::to_string(total) + " runs of further seeds", seed_s * static_cast<double>(count),
                    show_progress);

  std::vector<std::vector<RunSummary>> summaries(static_cast<std::size_t>(count), std::vector<RunSummary>(runs));
  std::vector<std::optional<Error>> errors(total);
  parallel_for(total, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto summary = drive(comparison, i % runs, static_cast<std::int64_t>(i / runs) + 1, scratch, progress);
      if (summary) {
        summaries[i / runs][i % runs] = *std::move(summary);
      } else {
        errors[i] = summary.error();
        if (errors[i]->key.empty()) errors[i]->key = "run " + comparison.plan[i % runs].name;
      }
    }
  });
  for (const auto& error : errors)
    if (error) return *error;
  results.further_seeds = std::move(summaries);
  results.peak_memory_mb = peak_memory_mb();
  results.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  return Ok{};
}

}  // namespace canyon::study
