#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/drive.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/report/html_report.h"
#include "canyon/study/registration_error/error_budget.h"
#include "canyon/study/seeds/further_seeds.h"

namespace canyon::apps {

namespace {

struct Options {
  MissionOptions mission;
  study::TapeChoice tape;
  study::BudgetOptions budget;
  std::string hidden = "both";
};

Result<std::vector<study::HiddenRemoval>> hidden_removals(const std::string& name) {
  using enum study::HiddenRemoval;
  if (name == "both") return std::vector{kHealed, kDropped};
  return std::vector{name == "healed" ? kHealed : kDropped};
}

Status write_files(const study::ErrorBudget& budget, const std::string& directory) {
  CANYON_TRY_STATUS(write_text_file(directory + "/error_budget.csv", study::error_budget_csv(budget)));
  CANYON_TRY_STATUS(
      write_text_file(directory + "/summary.json", json_text(study::error_budget_json(budget), 2) + "\n"));
  return report::write_html_report(directory, directory + "/report.html");
}

Result<int> run(const Options& options) {
  set_threads(options.mission.common.threads);
  study::BudgetOptions how = options.budget;
  CANYON_TRY(how.hidden, hidden_removals(options.hidden));
  how.show_progress = !options.mission.common.json;
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({how.fidelity}, "--fidelity"));
  CANYON_TRY(auto comparison, study::prepare_comparison(file, study::plan_runs({how.fidelity}, false)));
  CANYON_TRY_STATUS(study::check_seeds(comparison, how.seeds));
  CANYON_TRY_STATUS(study::choose_tape(options.tape, comparison));
  const mission::MissionConfig& config = comparison.configs.front();
  CANYON_TRY(auto directory, StagedDirectory::create(output_directory(options.mission, config), options.mission.force));
  CANYON_TRY(const study::ErrorBudget budget,
             study::make_error_budget(config, comparison.missions.front(), *comparison.tape, how));
  CANYON_TRY_STATUS(write_files(budget, directory.staging_path()));
  CANYON_TRY_STATUS(directory.commit());
  if (options.mission.common.json) {
    Json out = study::error_budget_json(budget);
    out["results_dir"] = directory.final_path();
    std::printf("%s\n", json_text(out).c_str());
    return 0;
  }
  const auto place = std::filesystem::absolute(directory.final_path()).lexically_normal();
  std::printf("%sResults: %s\n", study::error_budget_table(budget).c_str(), place.c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->mission);
  arguments
      .option("--fidelity", options->budget.fidelity,
              "low, paper, high, high_aided, modern, or one of the mission file's own")
      .default_shown();
  arguments.option("--seeds", options->budget.seeds, "so many, the mission's own the first; from two on with intervals")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{1000});
  arguments.option("--permutations", options->budget.permutations, "orders in which sources are taken away, per seed")
      .default_shown()
      .within(std::int64_t{2}, std::int64_t{1000});
  arguments
      .option("--hidden", options->hidden,
              "what a world without multipath does with hidden signals: healed, dropped, or both budgets")
      .default_shown()
      .among({"healed", "dropped", "both"});
  arguments
      .option(
          "--tape", options->tape.tape,
          "true motion to replay on: a .tape, or a results directory; else the mission's own route, driven on truth")
      .type("RUN_DIR");
  return [options] { return run(*options); };
}

}  // namespace

Verb lidar_error_budget_verb() {
  return {"lidar error-budget", "which source caused how much of the map's error",
          "canyon lidar error-budget my.toml --fidelity high --seeds 5 --out results/budget", declare};
}

}  // namespace canyon::apps
