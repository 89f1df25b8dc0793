#include "canyon/apps/options/drive.h"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/invocation.h"
#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/line/verb.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/html_report.h"
#include "canyon/study/plan/follow.h"
#include "canyon/study/results/over_seeds.h"
#include "canyon/study/results/results.h"
#include "canyon/study/seeds/further_seeds.h"
#include "canyon/study/seeds/open_loop_beside.h"

namespace canyon::apps {

namespace {

constexpr const char* kMakePlan = "make";

void print_json(const study::Results& results, const WhyAnswer& why, const std::string& directory,
                const std::string& hash) {
  nlohmann::ordered_json out = study::summary_json(results);
  // The contract's figures of cost stand beside the others, not under `timing`.
  const auto show_cost = [](nlohmann::ordered_json& runs) {
    for (auto& run : runs) {
      run["real_time_factor"] = run["timing"]["real_time_factor"];
      run["cpu_s"] = run["timing"]["cpu_s"];
    }
  };
  show_cost(out["runs"]);
  if (results.open_loop) show_cost(out["open_loop"]["runs"]);
  const Json explained = why_answer_json(why);
  if (!why.explanations.empty()) out["why"] = explained["failures"];
  if (!why.tally.empty()) out["why_tally"] = explained["tally"];
  out["seed"] = out["mission"]["seed"];
  out["results_dir"] = directory;
  out["hash"] = hash;
  std::printf("%s\n", json_text(out).c_str());
}

/// Each warning once, however many runs met it.
void print_warnings(const study::Results& results) {
  std::set<std::string> told;
  const auto tell = [&told](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
      if (told.insert(warning).second) print_warning(warning);
  };
  for (const auto& record : results.records) tell(record.warnings);
  if (results.open_loop) tell(results.open_loop->warnings);
}

}  // namespace

void declare_loop_options(Arguments& arguments, LoopOptions& options) {
  arguments.flag("--open-loop", options.open_loop,
                 "all runs on one true motion, whatever the autonomy asks for: errors are paired, there is no outcome; "
                 "without --tape or --trajectory on the mission's own route, driven on truth");
  const auto tape =
      arguments.option("--tape", options.tape.tape, "true motion to drive on: a .tape, or a results directory")
          .type("RUN_DIR");
  const auto trajectory =
      arguments
          .option("--trajectory", options.tape.trajectory,
                  "true motion to drive on: poses in the scene's frame (.tum, .kitti, .csv) or a geodetic reference")
          .type("FILE")
          .excludes(tape);
  arguments.option("--trajectory-rate", options.tape.trajectory_rate_hz, "poses per second of a file without times")
      .default_shown()
      .within(1e-3, 1e4)
      .needs(trajectory);
}

void declare_both_loops(Arguments& arguments, LoopOptions& options) {
  arguments.flag(
      "--both-loops", options.both,
      "each run drives by itself, and all but the mixed ones are on one true motion too, as with --open-loop: both "
      "side by side");
}

Status check_loop_options(const LoopOptions& options) {
  if (options.both && options.open_loop)
    return Error{.file = "--both-loops", .what = "drives the closed loop too", .expected = "no --open-loop beside it"};
  const bool on_tape = !options.tape.tape.empty() || !options.tape.trajectory.empty();
  if (!on_tape || options.open_loop || options.both) return Ok{};
  return Error{.file = options.tape.tape.empty() ? "--trajectory" : "--tape",
               .what = "is for open loops",
               .expected = "--open-loop beside it"};
}

void declare_figures_option(Arguments& arguments, FigureOptions& options) {
  arguments.option("--figures", options.figures,
                   "rows of the table, by their keys with commas between (canyon keys --figures); without it all");
}

void declare_plan_options(Arguments& arguments, PlanOptions& options) {
  const auto plan =
      arguments
          .option("--plan", options.plan,
                  "leave out what a plan says that is not needed: a file of canyon plan --write, or without one a plan "
                  "made here for each run")
          .type("FILE")
          .value_optional(kMakePlan);
  arguments
      .option("--for", options.outputs,
              "what somebody will read, with commas between: outcome, position, map, clouds; without it all four, or "
              "what the file's plan was made for")
      .needs(plan);
}

namespace {

Status check_plan(const PlanOptions& options, const LoopOptions& loop) {
  if (options.plan.empty() || !loop.both) return Ok{};
  return Error{.file = "--both-loops", .what = "a plan is for one loop", .expected = "no --plan beside it"};
}

Status follow_plan(const PlanOptions& options, study::Comparison& comparison) {
  if (options.plan.empty()) return Ok{};
  if (options.plan.ends_with(".toml"))
    return Error{.file = "--plan",
                 .what = "\"" + options.plan + "\" is a mission file",
                 .expected = "a plan file, or the mission before --plan"};
  std::optional<std::vector<study::Output>> outputs;
  if (!options.outputs.empty()) {
    CANYON_TRY(outputs, study::outputs_of(split_list(options.outputs), "--for"));
  }
  return study::follow_plan(options.plan == kMakePlan ? "" : options.plan, outputs, comparison);
}

}  // namespace

Result<int> drive_and_report(const MissionOptions& options, const LoopOptions& loop, const FigureOptions& figures,
                             const PlanOptions& leave_out, const mission::MissionFile& file,
                             const std::vector<study::RunPlan>& plan, const WhyOptions& why) {
  set_threads(options.common.threads);
  const auto keys = figures.figures.empty() ? std::vector<std::string>() : split_list(figures.figures);
  CANYON_TRY_STATUS(study::choose_figures(keys, "--figures"));
  CANYON_TRY_STATUS(check_loop_options(loop));
  CANYON_TRY_STATUS(check_why(
      why, {.open_loop = loop.open_loop, .plan = !leave_out.plan.empty(), .several_seeds = figures.seeds.has_value()}));
  CANYON_TRY_STATUS(check_plan(leave_out, loop));
  CANYON_TRY(auto comparison, study::prepare_comparison(file, plan));
  if (figures.seeds) CANYON_TRY_STATUS(study::check_seeds(comparison, *figures.seeds));
  const std::string directory = output_directory(options, comparison.configs.front());
  CANYON_TRY(auto staged, StagedDirectory::create(directory, options.force));
  if (loop.open_loop) CANYON_TRY_STATUS(study::choose_tape(loop.tape, comparison));
  std::optional<study::Comparison> beside;
  if (loop.both) {
    CANYON_TRY(beside, study::open_loop_beside(comparison, loop.tape));
  }
  CANYON_TRY_STATUS(follow_plan(leave_out, comparison));
  CANYON_TRY(auto results, study::compare(comparison, staged.staging_path(), !options.common.json));
  if (figures.seeds)
    CANYON_TRY_STATUS(
        study::add_further_seeds(comparison, *figures.seeds - 1, staged.staging_path(), !options.common.json, results));
  if (beside) {
    CANYON_TRY(results.open_loop,
               study::drive_open_loop(*beside, figures.seeds.value_or(1), staged.staging_path(), !options.common.json));
    results.wall_s += results.open_loop->wall_s;
    results.peak_memory_mb = study::peak_memory_mb();
  }
  CANYON_TRY(const WhyAnswer explained,
             explain(why, figures.seeds.has_value(), comparison, results, !options.common.json));
  if (explained.asked)
    CANYON_TRY_STATUS(
        write_text_file(staged.staging_path() + "/why.json", json_text(why_answer_json(explained)) + "\n"));
  results.command_line = invocation().command_line;
  results.commit = invocation().commit;
  CANYON_TRY(const std::string hash, study::write_results(staged.staging_path(), results));
  CANYON_TRY_STATUS(report::write_html_report(staged.staging_path(), staged.staging_path() + "/report.html"));
  throw_if_cancelled();
  CANYON_TRY_STATUS(staged.commit());

  print_warnings(results);
  if (options.common.json) {
    print_json(results, explained, staged.final_path(), hash);
    return 0;
  }
  const auto& mission = *results.mission;
  if (comparison.tape)
    std::printf("Open loop on %s: %.1f s of true motion, the same for all runs\n", comparison.tape->source.c_str(),
                comparison.tape->duration_s());
  std::printf("Mission %s, seed %lld, %s: %.0f m planned, nominal %.0f s, limit %.0f s\n\n",
              comparison.configs.front().run.name.c_str(), static_cast<long long>(comparison.configs.front().run.seed),
              mission.start.iso(0).c_str(), mission.prior.route.length_m(), mission.nominal_s, mission.time_limit_s);
  if (figures.seeds) {
    const study::OverSeeds found = study::over_seeds(runs_by_seed(results));
    std::printf("%s\n", study::over_seeds_table(found, keys).c_str());
    const std::string squares = study::squares_over_seeds(found, results.summaries);
    if (!squares.empty()) std::printf("%s\n", squares.c_str());
  } else {
    std::printf("%s\n", study::comparison_table(results, keys).c_str());
  }
  if (results.open_loop) std::printf("%s\n", study::both_loops_table(results, keys).c_str());
  print_why(explained);
  const auto place = std::filesystem::absolute(staged.final_path()).lexically_normal();
  std::printf("Driven in %.1f s.\nResults: %s\nReport:  %s\n", results.wall_s, place.c_str(),
              (place / "report.html").c_str());
  return 0;
}

}  // namespace canyon::apps
