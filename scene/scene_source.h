#pragma once

#include "canyon/scene/city/city.h"
#include "canyon/scene/city/traffic.h"
#include "canyon/scene/import.h"

namespace canyon::scene {

/// [scene] of a mission: the built-in city, or a scene read from files; and what moves in it.
struct SceneConfig {
  CityConfig city;
  ImportConfig from;
  std::vector<MovingConfig> moving;
  std::int64_t max_triangles = kMaxTriangles;
};
void visit(FieldVisitor& f, SceneConfig& c);

/// The scene that a configuration asks for, unless it is going to have more than max_triangles. lat_deg, lon_deg and
/// base_height_m of the city place files in local metres.
Result<ImportedScene> make_scene(const SceneConfig& config);

}  // namespace canyon::scene
