#include "canyon/apps/options/scene_options.h"

#include "canyon/mission/config/mission_file.h"

namespace canyon::apps {

void declare_scene_options(Arguments& arguments, SceneOptions& options, const char* scenes) {
  arguments.option("scene", options.scene, scenes).required().type("FILE");
  declare_import_options(arguments, options.from);
}

void declare_import_options(Arguments& arguments, scene::ImportConfig& from) {
  arguments.option("--more", from.more_files, "further files of the same place");
  arguments.option("--terrain", from.terrain, "elevation model: GeoTIFF, SRTM .hgt, ESRI ASCII grid");
  arguments.option("--crs", from.crs, "coordinate system in place of the file's own, as PROJ knows it");
  arguments
      .option("--undulation", from.undulation_m,
              "geoid above the ellipsoid, m; else GeographicLib's geoid where it is installed")
      .within(-200.0, 200.0);
  arguments.option("--materials", from.materials, "material tables over the built-in one");
}

Result<scene::SceneConfig> scene_config(const SceneOptions& options) {
  const bool mission_file = options.scene.ends_with(".toml");
  if (mission_file || options.scene == mission::kDefaultMission) {
    CANYON_TRY(const auto file, mission::MissionFile::load(mission_file ? options.scene : ""));
    CANYON_TRY(const mission::MissionConfig mission, file.resolve("high"));
    return mission.scene;
  }
  scene::SceneConfig config;
  config.from = options.from;
  config.from.file = options.scene;
  return config;
}

}  // namespace canyon::apps
