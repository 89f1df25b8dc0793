#include "canyon/scene/scene_source.h"

#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"

namespace canyon::scene {

void visit(FieldVisitor& f, SceneConfig& c) {
  visit(f, c.from);
  visit(f, c.city);
  f.integer("max_triangles", c.max_triangles, {1000, 4e9},
            "a scene that is going to have more is refused before it is made; each takes up to 300 bytes");
  f.list("moving", c.moving, "a thing that moves: every sensor meets it, and the vehicle must not");
}

Result<ImportedScene> make_scene(const SceneConfig& config) {
  const CityConfig& city = config.city;
  if (!config.from.file.empty())
    return import_scene(config.from, {city.lat_deg * kDegree, city.lon_deg * kDegree, city.base_height_m},
                        config.max_triangles);
  ImportedScene out;
  out.report.predicted = predicted_cost(city);
  CANYON_TRY_STATUS(check_cost(out.report.predicted, config.max_triangles,
                               "scene.extent_m, scene.terrain_cell_m, scene.max_triangles",
                               "a smaller city (scene.extent_m), larger cells (scene.terrain_cell_m)"));
  const Progress progress("city of about " + cost_text(out.report.predicted), 1.0);
  out.parts = make_city(city);
  CANYON_TRY(out.parts.materials, load_materials(config.from.materials));
  if (city.absorbing)
    for (Material& m : out.parts.materials) m.rf_absorbing = true;
  out.report.vertical = "ellipsoid";
  out.report.undulation_source = "none";
  out.report.ground = out.report.streets = "built in";
  return out;
}

}  // namespace canyon::scene
