#include "canyon/study/compare.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "canyon/core/process/free_memory.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/recorder/run_files.h"
#include "canyon/mission/run.h"

namespace canyon::study {

std::vector<RunPlan> plan_runs(const std::vector<std::string>& fidelities, bool two_by_two,
                               const std::vector<std::string>& filters) {
  std::vector<RunPlan> plan;
  for (const auto& fidelity : fidelities) plan.push_back({fidelity, fidelity, fidelity, {}});
  if (two_by_two) {
    const std::string &first = fidelities.at(0), &second = fidelities.at(1);
    plan.push_back({second + "_gnss_" + first + "_imu", second, first, {}});
    plan.push_back({first + "_gnss_" + second + "_imu", first, second, {}});
  }
  if (filters.empty()) return plan;
  std::vector<RunPlan> each;
  for (const RunPlan& run : plan)
    for (const std::string& filter : filters) each.push_back({run.name + "_" + filter, run.gnss, run.imu, filter});
  return each;
}

namespace {

/// The named set, whatever rows the mission names in place of some.
void take_filter(const std::string& name, fusion::FilterConfig& config) {
  if (name.empty()) return;
  const fusion::FilterConfig plain;
  config.filter = name;
  config.states = plain.states;
  config.measurements = plain.measurements;
  config.acceptance = plain.acceptance;
}

}  // namespace

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
    take_filter(run.filter, config.fusion);
    auto prepared = mission::prepare(config, scenes);
    if (!prepared) return file.locate(prepared.error(), run.gnss, run.imu);
    comparison.configs.push_back(std::move(config));
    comparison.missions.push_back(*std::move(prepared));
  }
  give_back_free_memory();  // of the making of scenes, before the runs' maps grow
  return comparison;
}

const mission::Omissions* omissions(const Comparison& comparison, std::size_t i) {
  return comparison.plans.empty() ? nullptr : &comparison.plans[i].omissions;
}

namespace {

/// One run of a comparison, with what it leaves behind.
struct DrivenRun {
  mission::RunRecord record;
  std::unique_ptr<RunStatistics> statistics;
  RunSummary summary;
};

Result<DrivenRun> drive(const Comparison& comparison, std::size_t i, const std::string& directory, Progress& progress) {
  const RunPlan& plan = comparison.plan[i];
  const mission::PreparedMission& mission = comparison.missions[i];
  const Tape* tape = comparison.tape ? &*comparison.tape : nullptr;
  DrivenRun run;
  run.statistics = std::make_unique<RunStatistics>(mission.scene->frame(), directory);
  std::vector<mission::Recorder*> recorders{run.statistics.get()};
  std::unique_ptr<mission::RunFiles> files;
  if (!directory.empty()) {
    CANYON_TRY(files, mission::RunFiles::create(directory, plan.name, comparison.configs[i], mission, tape));
    recorders.push_back(files.get());
  }
  mission::Recorders all(std::move(recorders));
  CANYON_TRY(run.record,
             mission::run_mission(
                 comparison.configs[i], mission, &progress,
                 {.tape = tape, .recorder = &all, .autonomy = nullptr, .omissions = omissions(comparison, i)}));
  run.record.name = plan.name;
  run.record.gnss = plan.gnss;
  run.record.imu = plan.imu;
  run.record.filter = plan.filter;
  CANYON_TRY(run.summary, summarize(run.record, *run.statistics));
  return run;
}

}  // namespace

Result<Results> compare(const Comparison& comparison, const std::string& directory, bool show_progress) {
  const auto wall_start = std::chrono::steady_clock::now();
  const std::size_t count = comparison.plan.size();
  double total_s = 0.0;
  for (const auto& mission : comparison.missions)
    total_s += comparison.tape ? comparison.tape->duration_s() : std::min(mission.nominal_s, mission.time_limit_s);
  Progress progress("driving " + std::to_string(count) + (count == 1 ? " run" : " runs"), total_s, show_progress);

  std::vector<std::optional<Result<DrivenRun>>> runs(count);
  parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) runs[i] = drive(comparison, i, directory, progress);
  });
  Results results;
  for (std::size_t i = 0; i < count; ++i) {
    if (!runs[i]->ok()) {
      Error error = runs[i]->error();
      if (error.key.empty()) error.key = "run " + comparison.plan[i].name;
      return error;
    }
    DrivenRun& run = **runs[i];
    if (comparison.tape && i > 0) {
      CANYON_TRY(PairedErrors paired,
                 paired_errors((*runs[0])->statistics->errors(), run.statistics->errors(), run.record.start));
      paired.a = comparison.plan[0].name;
      paired.b = comparison.plan[i].name;
      results.paired.push_back(std::move(paired));
    }
    results.summaries.push_back(std::move(run.summary));
    results.records.push_back(std::move(run.record));
  }
  results.mission = &comparison.missions.front();
  results.plans = comparison.plans;
  if (comparison.tape) results.tape_source = comparison.tape->source;
  results.threads = threads();
  results.peak_memory_mb = peak_memory_mb();
  results.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  return results;
}

}  // namespace canyon::study
