#include <memory>

#include "canyon/apps/options/drive.h"

namespace canyon::apps {

namespace {

VerbAction declare(Arguments& arguments) {
  struct Options {
    MissionOptions mission;
    LoopOptions loop;
    FigureOptions figures;
    PlanOptions leave_out;
    std::string fidelity = "high";
  };
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->mission);
  declare_loop_options(arguments, options->loop);
  declare_figures_option(arguments, options->figures);
  declare_plan_options(arguments, options->leave_out);
  arguments
      .option("--fidelity", options->fidelity, "low, paper, high, high_aided, modern, or one of the mission file's own")
      .default_shown();
  return [options]() -> Result<int> {
    CANYON_TRY(const auto file, load_mission(options->mission));
    CANYON_TRY_STATUS(file.check_fidelities({options->fidelity}, "--fidelity"));
    return drive_and_report(options->mission, options->loop, options->figures, options->leave_out, file,
                            study::plan_runs({options->fidelity}, false));
  };
}

}  // namespace

Verb run_verb() {
  return {"run", "one mission at one fidelity", "canyon run my.toml --fidelity high --out results/first", declare};
}

}  // namespace canyon::apps
