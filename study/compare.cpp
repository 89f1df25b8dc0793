#include "canyon/study/compare.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/run.h"

namespace canyon::study {

std::vector<RunPlan> plan_runs(const std::vector<std::string>& fidelities, bool two_by_two) {
  std::vector<RunPlan> plan;
  for (const auto& fidelity : fidelities) plan.push_back({fidelity, fidelity, fidelity});
  if (two_by_two) {
    const std::string &first = fidelities.at(0), &second = fidelities.at(1);
    plan.push_back({second + "_gnss_" + first + "_imu", second, first});
    plan.push_back({first + "_gnss_" + second + "_imu", first, second});
  }
  return plan;
}

Result<Comparison> prepare_comparison(const mission::MissionFile& file, const std::vector<RunPlan>& plan) {
  Comparison comparison;
  comparison.plan = plan;
  mission::SceneCache scenes;
  for (std::size_t i = 0; i < plan.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (plan[k].name == plan[i].name)
        return Error{.what = "two runs would be named \"" + plan[i].name + "\"",
                     .expected = "another name for the fidelity"};
  for (const RunPlan& run : plan) {
    CANYON_TRY(auto config, run.gnss == run.imu ? file.resolve(run.gnss) : file.resolve_mixed(run.gnss, run.imu));
    auto prepared = mission::prepare(config, scenes);
    if (!prepared) return file.locate(prepared.error(), run.gnss, run.imu);
    comparison.configs.push_back(std::move(config));
    comparison.missions.push_back(*std::move(prepared));
  }
  return comparison;
}

Result<Results> compare(const Comparison& comparison, bool show_progress) {
  const auto wall_start = std::chrono::steady_clock::now();
  const std::size_t count = comparison.plan.size();
  double total_s = 0.0;
  for (const auto& mission : comparison.missions)
    total_s += comparison.tape ? comparison.tape->duration_s() : std::min(mission.nominal_s, mission.time_limit_s);
  Progress progress("driving " + std::to_string(count) + (count == 1 ? " run" : " runs"), total_s, show_progress);

  std::vector<std::optional<mission::RunRecord>> records(count);
  std::vector<std::optional<Error>> errors(count);
  parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto record = mission::run_mission(comparison.configs[i], comparison.missions[i], &progress,
                                         {.tape = comparison.tape ? &*comparison.tape : nullptr, .autonomy = nullptr});
      if (record) {
        records[i] = *std::move(record);
      } else {
        errors[i] = record.error();
        if (errors[i]->key.empty()) errors[i]->key = "run " + comparison.plan[i].name;
      }
    }
  });
  Results results;
  for (std::size_t i = 0; i < count; ++i) {
    if (errors[i]) return *errors[i];
    records[i]->name = comparison.plan[i].name;
    records[i]->gnss = comparison.plan[i].gnss;
    records[i]->imu = comparison.plan[i].imu;
    results.summaries.push_back(summarize(*records[i]));
    results.records.push_back(*std::move(records[i]));
  }
  results.mission = &comparison.missions.front();
  if (comparison.tape) results.tape_source = comparison.tape->source;
  results.threads = threads();
  results.peak_memory_mb = peak_memory_mb();
  results.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  return results;
}

}  // namespace canyon::study
