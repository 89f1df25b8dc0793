#include "scene/scene_source.h"

#include "core/units.h"

namespace canyon::scene {

void visit(FieldVisitor& f, SceneConfig& c) {
  visit(f, c.from);
  visit(f, c.city);
  f.list("moving", c.moving, "a thing that moves: every sensor meets it, and the vehicle must not");
}

Result<ImportedScene> make_scene(const SceneConfig& config) {
  const CityConfig& city = config.city;
  if (!config.from.file.empty())
    return import_scene(config.from, {city.lat_deg * kDegree, city.lon_deg * kDegree, city.base_height_m});
  ImportedScene out;
  out.parts = make_city(city);
  CANYON_TRY(out.parts.materials, load_materials(config.from.materials));
  if (city.absorbing)
    for (Material& m : out.parts.materials) m.rf_absorbing = true;
  out.report = {.crs = {},
                .vertical = "ellipsoid",
                .undulation_source = "none",
                .ground = "built in",
                .streets = "built in",
                .warnings = {}};
  return out;
}

}  // namespace canyon::scene
