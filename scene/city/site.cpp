#include "canyon/scene/city/site.h"

#include "canyon/core/units.h"
#include "canyon/scene/city/buildings.h"
#include "canyon/scene/city/plan.h"

namespace canyon::scene {

std::optional<Site> planned_site(const SceneConfig& config) {
  if (!config.from.file.empty()) return std::nullopt;
  const CityConfig& city = config.city;
  const city::Plan plan = city::make_plan(city);
  Site site;
  site.frame = LocalFrame({city.lat_deg * kDegree, city.lon_deg * kDegree, city.base_height_m});
  site.high_W.setConstant(0.5 * city.extent_m);
  site.low_W = -site.high_W;
  site.extent_keys = extent_keys(config);
  site.streets = plan.streets;
  if (!city.empty) site.buildings = city::planned_buildings(city, plan);
  return site;
}

Site site_of(const Scene& scene, const SceneConfig& config) {
  return {scene.frame(),
          scene.extent().min.head<2>(),
          scene.extent().max.head<2>(),
          extent_keys(config),
          scene.streets(),
          scene.buildings()};
}

std::string extent_keys(const SceneConfig& config) {
  if (config.from.file.empty()) return "scene.extent_m";
  std::string keys = "scene.margin_m";
  if (!config.from.center_deg.empty()) keys += ", scene.center_deg";
  if (config.from.radius_m > 0.0) keys += ", scene.radius_m";
  return keys;
}

}  // namespace canyon::scene
