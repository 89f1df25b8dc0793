#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/scene_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/scene/written_scene.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  SceneOptions scene;
  scene::CityConfig city;
  std::string out = "scene";
  bool force = false;
};

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
  scene::SceneConfig config{.city = options.city, .from = {}, .moving = {}};
  if (options.scene.scene != "city") {
    CANYON_TRY(config, scene_config(options.scene));
  }
  CANYON_TRY(const scene::ImportedScene made, scene::make_scene(config));
  const scene::SceneParts& parts = made.parts;
  CANYON_TRY_STATUS(scene::write_scene(parts, staged.staging_path()));
  CANYON_TRY_STATUS(staged.commit());
  const std::size_t triangles = parts.mesh.triangles.size(), buildings = parts.buildings.size();
  if (options.common.json) {
    const nlohmann::ordered_json json{
        {"name", parts.name}, {"buildings", buildings}, {"triangles", triangles}, {"directory", staged.final_path()}};
    std::printf("%s\n", json_text(json).c_str());
    return 0;
  }
  std::printf(
      "%s: %zu buildings, %zu triangles\n\nFiles: %s/scene.json (what canyon reads), scene.obj, scene.mtl, "
      "materials.toml\n",
      parts.name.c_str(), buildings, triangles, staged.final_path().c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  declare_scene_options(arguments, options->scene,
                        "\"city\", the built-in one; or a scene file, or a mission file's scene");
  scene::CityConfig& city = options->city;
  arguments.option("--seed", city.seed, "seed of the built-in city")
      .default_shown()
      .within(std::int64_t{0}, kLargestSeed);
  arguments.option("--extent", city.extent_m, "edge of the square, m")
      .default_shown()
      .within(scene::kCityExtent_m.min, scene::kCityExtent_m.max);
  arguments.option("--block", city.block_m, "street to street, m")
      .default_shown()
      .within(scene::kCityBlock_m.min, scene::kCityBlock_m.max);
  arguments.option("--slope", city.slope_percent, "mean slope of the terrain, percent")
      .default_shown()
      .within(scene::kCitySlope_percent.min, scene::kCitySlope_percent.max);
  arguments.option("--out", options->out, "directory for the files").default_shown();
  arguments.flag("--force", options->force,
                 "replace the directory if it exists; only one that canyon wrote, or an empty one");
  return [options] { return run(*options); };
}

}  // namespace

Verb scene_make_verb() {
  return {"scene make", "the built-in city, or any scene, as files: OBJ and MTL, materials, streets",
          "canyon scene make city --seed 7 --out my_city", declare};
}

}  // namespace canyon::apps
