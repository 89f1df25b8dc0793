#pragma once

#include <string>
#include <vector>

#include "canyon/core/output/json.h"
#include "canyon/scene/import.h"
#include "canyon/scene/inspect.h"

namespace canyon::apps {

/// What `scene info` says: as JSON, as text, as a picture.
struct SceneFacts {
  SceneFacts(const scene::Scene& scene, const scene::ImportReport& report);

  const scene::Scene& scene;
  const scene::ImportReport& report;
  scene::Extent extent;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  double height_sum_m = 0.0;
  std::vector<scene::MaterialArea> materials;
  scene::Soundness sound;
  scene::SensorNeeds needs;
};
Json scene_json(const SceneFacts& facts);
void print_scene(const SceneFacts& facts);

/// The scene from above, PNG if `path` ends so, else SVG.
std::string scene_picture(const scene::Scene& scene, double cell_m, const std::string& path);

}  // namespace canyon::apps
