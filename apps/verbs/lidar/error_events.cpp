#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/fidelity_study.h"
#include "canyon/study/registration_error/events/error_events.h"

namespace canyon::apps {

namespace {

struct Options {
  FidelityStudyOptions study;
  study::ErrorEventsOptions events;
};

Result<int> run(const Options& options) {
  study::ErrorEventsOptions how = options.events;
  how.fidelity = options.study.fidelity;
  how.seeds = options.study.seeds;
  how.show_progress = !options.study.mission.common.json;
  CANYON_TRY(auto study, begin_study(options.study));
  CANYON_TRY(const study::ErrorEvents events,
             study::find_error_events(study.config(), study.mission(), *study.tape(), how));
  return finish_study(options.study, study, study::error_events_json(events), study::error_events_table(events),
                      {{"error_events.csv", study::error_events_csv(events)}}, true);
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  options->study.seeds = options->events.seeds;
  declare_mission_options(arguments, options->study.mission);
  declare_fidelity_option(arguments, options->study);
  declare_seeds_option(arguments, options->study, "; from six on with bands");
  arguments
      .option("--starts", options->events.starts,
              "times of day that each seed is driven at, evenly from the mission's own on: elsewhere an event has its "
              "placebos")
      .default_shown()
      .within(std::int64_t{2}, std::int64_t{100});
  declare_tape_option(arguments, options->study);
  return [options] { return run(*options); };
}

}  // namespace

Verb lidar_error_events_verb() {
  return {"lidar error-events", "what jumps of the sky and of the estimate do to map and keyframes, beside placebos",
          "canyon lidar error-events my.toml --fidelity high --seeds 20 --out results/events", declare};
}

}  // namespace canyon::apps
