#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/scene_facts.h"
#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/scene_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  SceneOptions scene;
  std::string picture;
  double cell_m = 1.0;
  bool force = false;
};

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  OutputSet outputs(options.force);
  CANYON_TRY(StagedFile* const picture, outputs.file(options.picture));
  CANYON_TRY(const scene::SceneConfig config, scene_config(options.scene));
  CANYON_TRY(scene::ImportedScene made, scene::make_scene(config));
  const scene::Scene scene(std::move(made.parts));
  const SceneFacts facts(scene, made.report);
  if (picture != nullptr && !scene.mesh().triangles.empty()) {
    CANYON_TRY_STATUS(picture->write(scene_picture(scene, options.cell_m, options.picture)));
    CANYON_TRY_STATUS(outputs.commit());
  }
  if (options.common.json)
    std::printf("%s\n", json_text(scene_json(facts)).c_str());
  else
    print_scene(facts);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  declare_scene_options(arguments, options->scene, "a scene file, a mission file's scene, or \"vicksburg\" (built in)");
  arguments.option("--picture", options->picture, "draws the scene from above: .svg or .png");
  arguments.flag("--force", options->force, "replace the picture if it exists");
  arguments.option("--cell", options->cell_m, "of the picture, m").default_shown().within(0.1, 100.0);
  return [options] { return run(*options); };
}

}  // namespace

Verb scene_info_verb() {
  return {"scene info", "what is in a scene: extents, materials, soundness, what a run needs of it",
          "canyon scene info shibuya.geojson --undulation 36.7 --picture shibuya.svg", declare};
}

}  // namespace canyon::apps
