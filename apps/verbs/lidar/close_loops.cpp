#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/drive.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/study/closures/closed_map.h"

namespace canyon::apps {

namespace {

struct CloseLoops {
  MissionOptions mission;
  apps::LoopOptions loop;
  std::string fidelity = "high";
  lidar::ClosureOptions closures;
};

Status write_closed(const study::ClosedMap& closed, const std::string& directory) {
  CANYON_TRY_STATUS(write_text_file(directory + "/summary.json", json_text(study::closed_map_json(closed), 2) + "\n"));
  return write_tum(directory + "/closed.tum", closed.X_WL_closed);
}

Result<int> close_loops(const CloseLoops& options) {
  set_threads(options.mission.common.threads);
  CANYON_TRY_STATUS(check_loop_options(options.loop));
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({options.fidelity}, "--fidelity"));
  CANYON_TRY(auto comparison, study::prepare_comparison(file, study::plan_runs({options.fidelity}, false)));
  if (options.loop.open_loop) CANYON_TRY_STATUS(study::choose_tape(options.loop.tape, comparison));
  const mission::MissionConfig& config = comparison.configs.front();
  CANYON_TRY(auto directory, StagedDirectory::create(output_directory(options.mission, config), options.mission.force));
  CANYON_TRY(const study::ClosedMap closed,
             study::make_closed_map(config, comparison.missions.front(), comparison.tape ? &*comparison.tape : nullptr,
                                    options.fidelity, options.closures, !options.mission.common.json));
  CANYON_TRY_STATUS(write_closed(closed, directory.staging_path()));
  CANYON_TRY_STATUS(directory.commit());
  if (options.mission.common.json) {
    Json out = study::closed_map_json(closed);
    out["results_dir"] = directory.final_path();
    std::printf("%s\n", json_text(out).c_str());
    return 0;
  }
  const auto place = std::filesystem::absolute(directory.final_path()).lexically_normal();
  std::printf("%sResults: %s\n", study::closed_map_table(closed).c_str(), place.c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<CloseLoops>();
  declare_mission_options(arguments, options->mission);
  declare_loop_options(arguments, options->loop);
  arguments
      .option("--fidelity", options->fidelity, "low, paper, high, high_aided, modern, or one of the mission file's own")
      .default_shown();
  arguments.option("--within", options->closures.within_m, "metres to an earlier place that is looked at again")
      .default_shown()
      .within(0.1, 1000.0);
  arguments.option("--least-way", options->closures.least_way_m, "metres driven since, below which it is no loop")
      .default_shown()
      .within(0.0, 1e6);
  arguments.option("--apart", options->closures.apart_m, "metres driven from one look back to the next")
      .default_shown()
      .within(0.0, 1000.0);
  arguments.option("--least-overlap", options->closures.least_overlap, "share of the points that must be matched")
      .default_shown()
      .within(0.0, 1.0);
  return [options] { return close_loops(*options); };
}

}  // namespace

Verb lidar_close_loops_verb() {
  return {"lidar close-loops", "a mission's map with its loops closed after the run, by a graph of its keyframes",
          "canyon lidar close-loops missions/parking_lot/circle.toml --fidelity high --out closed", declare};
}

}  // namespace canyon::apps
