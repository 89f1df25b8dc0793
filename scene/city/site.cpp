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
  site.streets = plan.streets;
  if (!city.empty) site.buildings = city::planned_buildings(city, plan);
  return site;
}

Site site_of(const Scene& scene) {
  return {scene.frame(), scene.extent().min.head<2>(), scene.extent().max.head<2>(), scene.streets(),
          scene.buildings()};
}

}  // namespace canyon::scene
