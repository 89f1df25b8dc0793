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
#include "canyon/study/registration_error/events/error_events.h"
#include "canyon/study/seeds/further_seeds.h"

namespace canyon::apps {

namespace {

struct Options {
  MissionOptions mission;
  study::TapeChoice tape;
  study::ErrorEventsOptions events;
};

Status write_files(const study::ErrorEvents& events, const std::string& directory) {
  CANYON_TRY_STATUS(write_text_file(directory + "/error_events.csv", study::error_events_csv(events)));
  CANYON_TRY_STATUS(
      write_text_file(directory + "/summary.json", json_text(study::error_events_json(events), 2) + "\n"));
  return report::write_html_report(directory, directory + "/report.html");
}

Result<int> run(const Options& options) {
  set_threads(options.mission.common.threads);
  study::ErrorEventsOptions how = options.events;
  how.show_progress = !options.mission.common.json;
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({how.fidelity}, "--fidelity"));
  CANYON_TRY(auto comparison, study::prepare_comparison(file, study::plan_runs({how.fidelity}, false)));
  CANYON_TRY_STATUS(study::check_seeds(comparison, how.seeds));
  CANYON_TRY_STATUS(study::choose_tape(options.tape, comparison));
  const mission::MissionConfig& config = comparison.configs.front();
  CANYON_TRY(auto directory, StagedDirectory::create(output_directory(options.mission, config), options.mission.force));
  CANYON_TRY(const study::ErrorEvents events,
             study::find_error_events(config, comparison.missions.front(), *comparison.tape, how));
  CANYON_TRY_STATUS(write_files(events, directory.staging_path()));
  CANYON_TRY_STATUS(directory.commit());
  if (options.mission.common.json) {
    Json out = study::error_events_json(events);
    out["results_dir"] = directory.final_path();
    std::printf("%s\n", json_text(out).c_str());
    return 0;
  }
  const auto place = std::filesystem::absolute(directory.final_path()).lexically_normal();
  std::printf("%s\nResults: %s\n", study::error_events_table(events).c_str(), place.c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->mission);
  arguments
      .option("--fidelity", options->events.fidelity,
              "low, paper, high, high_aided, modern, or one of the mission file's own")
      .default_shown();
  arguments.option("--seeds", options->events.seeds, "so many, the mission's own the first; from six on with bands")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{1000});
  arguments
      .option("--starts", options->events.starts,
              "times of day that each seed is driven at, evenly from the mission's own on: elsewhere an event has its "
              "placebos")
      .default_shown()
      .within(std::int64_t{2}, std::int64_t{100});
  arguments
      .option(
          "--tape", options->tape.tape,
          "true motion to replay on: a .tape, or a results directory; else the mission's own route, driven on truth")
      .type("RUN_DIR");
  return [options] { return run(*options); };
}

}  // namespace

Verb lidar_error_events_verb() {
  return {"lidar error-events", "what jumps of the sky and of the estimate do to map and keyframes, beside placebos",
          "canyon lidar error-events my.toml --fidelity high --seeds 20 --out results/events", declare};
}

}  // namespace canyon::apps
