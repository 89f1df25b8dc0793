#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/drive.h"
#include "canyon/apps/options/fidelity_study.h"
#include "canyon/study/loops/closed_map.h"

namespace canyon::apps {

namespace {

struct Options {
  FidelityStudyOptions study;
  LoopOptions loop;
  lidar::ClosureOptions closures;
};

Result<int> run(const Options& options) {
  CANYON_TRY_STATUS(check_loop_options(options.loop));
  FidelityStudyOptions how = options.study;
  how.open_loop = options.loop.open_loop;
  how.tape = options.loop.tape;
  CANYON_TRY(auto study, begin_study(how));
  CANYON_TRY(const study::ClosedMap closed,
             study::make_closed_map(study.config(), study.mission(), study.tape(), how.fidelity, options.closures,
                                    !how.mission.common.json));
  CANYON_TRY_STATUS(write_tum(study.directory.staging_path() + "/closed.tum", closed.X_WL_closed));
  return finish_study(how, study, study::closed_map_json(closed), study::closed_map_table(closed), {}, false);
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->study.mission);
  declare_loop_options(arguments, options->loop);
  declare_fidelity_option(arguments, options->study);
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
  return [options] { return run(*options); };
}

}  // namespace

Verb lidar_close_loops_verb() {
  return {"lidar close-loops", "a mission's map with its loops closed after the run, by a graph of its keyframes",
          "canyon lidar close-loops missions/parking_lot/circle.toml --fidelity high --out closed", declare};
}

}  // namespace canyon::apps
