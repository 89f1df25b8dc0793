#include <memory>

#include <CLI/CLI.hpp>

#include "apps/drive.h"

namespace canyon::apps {

namespace {

VerbAction declare(CLI::App& app) {
  struct Options {
    MissionOptions mission;
    std::string fidelity = "high";
  };
  const auto options = std::make_shared<Options>();
  declare_mission_options(app, options->mission);
  app.add_option("--fidelity", options->fidelity, "low, paper, high, or one of the mission file's own")
      ->capture_default_str();
  return [options]() -> Result<int> {
    CANYON_TRY(const auto file, load_mission(options->mission));
    CANYON_TRY_STATUS(file.check_fidelities({options->fidelity}, "--fidelity"));
    return drive_and_report(options->mission, file, study::plan_runs({options->fidelity}, false));
  };
}

}  // namespace

Verb run_verb() {
  return {"run", "one mission at one fidelity", "canyon run my.toml --fidelity high --out results/first", declare};
}

}  // namespace canyon::apps
