#include <memory>

#include <CLI/CLI.hpp>

#include "apps/drive.h"

namespace canyon::apps {

namespace {

VerbAction declare(CLI::App& app) {
  struct Options {
    MissionOptions mission;
    std::vector<std::string> fidelities{"low", "high", "paper"};
    bool no_two_by_two = false;
  };
  const auto options = std::make_shared<Options>();
  declare_mission_options(app, options->mission);
  app.add_option("--fidelities", options->fidelities, "runs to compare; the ratio is second over first")
      ->delimiter(',');
  app.add_flag("--no-2x2", options->no_two_by_two, "leave out the mixed runs low/high GNSS x low/high IMU");
  return [options]() -> Result<int> {
    CANYON_TRY(const auto file, load_mission(options->mission));
    const auto has = [&](const char* name) {
      return std::find(options->fidelities.begin(), options->fidelities.end(), name) != options->fidelities.end();
    };
    const bool square = !options->no_two_by_two && has("low") && has("high");
    return drive_and_report(options->mission, file, study::plan_runs(options->fidelities, square));
  };
}

}  // namespace

Verb compare_verb() {
  return {"compare", "the same mission at several fidelities, side by side, on the same random numbers",
          "canyon compare my.toml --seed 7 --nav brdc1820.10n --start 2010-07-01T13:00:00", declare};
}

}  // namespace canyon::apps
