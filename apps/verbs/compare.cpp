#include <memory>

#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/options/drive.h"

namespace canyon::apps {

namespace {

VerbAction declare(Arguments& arguments) {
  struct Options {
    MissionOptions mission;
    LoopOptions loop;
    FigureOptions figures;
    PlanOptions leave_out;
    WhyOptions why;
    std::string fidelities = "low,high,paper";
    std::string filters;
    bool no_two_by_two = false;
  };
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->mission);
  declare_loop_options(arguments, options->loop);
  declare_both_loops(arguments, options->loop);
  declare_figures_option(arguments, options->figures);
  declare_plan_options(arguments, options->leave_out);
  declare_why_options(arguments, options->why);
  arguments
      .option("--seeds", options->figures.seeds,
              "every run with so many seeds, from the mission's own on: shares of success, medians and paired "
              "differences with their intervals; epochs and clouds are kept of the first seed only")
      .within(std::int64_t{2}, std::int64_t{100'000});
  arguments
      .option("--fidelities", options->fidelities,
              "runs to compare, with commas between: low, paper, high, high_aided, modern, or the mission file's own; "
              "ratios are second "
              "over first")
      .default_shown();
  arguments.option("--filters", options->filters,
                   "each run with each of these, with commas between: naive, vehicle, tight; with --seeds or "
                   "--open-loop GNSS by IMU "
                   "by filter");
  arguments.flag(
      "--no-2x2", options->no_two_by_two,
      "with --seeds or --open-loop, which have them: leave out the runs with the GNSS of the first fidelity and "
      "the IMU of the second, and the reverse");
  return [options]() -> Result<int> {
    CANYON_TRY(const auto file, load_mission(options->mission));
    const std::vector<std::string> fidelities = split_list(options->fidelities);
    CANYON_TRY_STATUS(file.check_fidelities(fidelities, "--fidelities"));
    const std::vector<std::string> filters =
        options->filters.empty() ? std::vector<std::string>() : split_list(options->filters);
    for (const std::string& filter : filters) CANYON_TRY_STATUS(choose(fusion::filter_sets(), filter, "--filters"));
    // One closed loop of each says nothing of what the GNSS does and what the IMU: each goes where its errors lead it.
    const bool judged = options->loop.open_loop || options->figures.seeds;
    const bool square = judged && !options->no_two_by_two && fidelities.size() > 1;
    return drive_and_report(options->mission, options->loop, options->figures, options->leave_out, file,
                            study::plan_runs(fidelities, square, filters), options->why);
  };
}

}  // namespace

Verb compare_verb() {
  return {"compare", "the same mission at several fidelities, side by side, on the same random numbers",
          "canyon compare my.toml --seed 7 --nav brdc1820.10n --start 2010-07-01T13:00:00", declare};
}

}  // namespace canyon::apps
