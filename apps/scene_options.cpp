#include "apps/scene_options.h"

#include <CLI/CLI.hpp>

#include "mission/mission_file.h"

namespace canyon::apps {

void declare_scene_options(CLI::App& app, SceneOptions& options) {
  scene::ImportConfig& from = options.from;
  app.add_option("scene", options.scene, "a scene file, a mission file's scene, or \"vicksburg\" (built in)")
      ->required()
      ->type_name("FILE");
  app.add_option("--more", from.more_files, "further files of the same place");
  app.add_option("--terrain", from.terrain, "elevation model: GeoTIFF, SRTM .hgt, ESRI ASCII grid");
  app.add_option("--crs", from.crs, "coordinate system in place of the file's own, as PROJ knows it");
  app.add_option("--undulation", from.undulation_m,
                 "geoid above the ellipsoid, m; else GeographicLib's geoid where it is installed");
  app.add_option("--materials", from.materials, "material tables over the built-in one");
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
