#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/fidelity_study.h"
#include "canyon/study/registration_error/error_budget.h"

namespace canyon::apps {

namespace {

struct Options {
  FidelityStudyOptions study;
  study::BudgetOptions budget;
  std::string hidden = "both";
};

Result<std::vector<study::HiddenRemoval>> hidden_removals(const std::string& name) {
  using enum study::HiddenRemoval;
  if (name == "both") return std::vector{kHealed, kDropped};
  return std::vector{name == "healed" ? kHealed : kDropped};
}

Result<int> run(const Options& options) {
  study::BudgetOptions how = options.budget;
  CANYON_TRY(how.hidden, hidden_removals(options.hidden));
  how.fidelity = options.study.fidelity;
  how.seeds = options.study.seeds;
  how.show_progress = !options.study.mission.common.json;
  CANYON_TRY(auto study, begin_study(options.study));
  CANYON_TRY(const study::ErrorBudget budget,
             study::make_error_budget(study.config(), study.mission(), *study.tape(), how));
  return finish_study(options.study, study, study::error_budget_json(budget), study::error_budget_table(budget),
                      {{"error_budget.csv", study::error_budget_csv(budget)}}, true);
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->study.mission);
  declare_fidelity_option(arguments, options->study);
  declare_seeds_option(arguments, options->study, "; from two on with intervals");
  arguments.option("--permutations", options->budget.permutations, "orders in which sources are taken away, per seed")
      .default_shown()
      .within(std::int64_t{2}, std::int64_t{1000});
  arguments
      .option("--hidden", options->hidden,
              "what a world without multipath does with hidden signals: healed, dropped, or both budgets")
      .default_shown()
      .among({"healed", "dropped", "both"});
  arguments
      .option("--keep-mb", options->budget.keep_mb,
              "memory for scans and clouds that replays hand on to one another; 0: each makes its own")
      .default_shown()
      .within(std::int64_t{0}, std::int64_t{1000000});
  declare_tape_option(arguments, options->study);
  return [options] { return run(*options); };
}

}  // namespace

Verb lidar_error_budget_verb() {
  return {"lidar error-budget", "which source caused how much of the map's error",
          "canyon lidar error-budget my.toml --fidelity high --seeds 5 --out results/budget", declare};
}

}  // namespace canyon::apps
