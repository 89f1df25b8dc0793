#include "canyon/scene/city/city.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/buildings.h"
#include "canyon/scene/city/furniture.h"
#include "canyon/scene/city/plan.h"
#include "canyon/scene/city/terrain.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::scene {

void visit(FieldVisitor& f, CityConfig& c) {
  f.integer("seed", c.seed, {0, 9007199254740992.0}, "the same number always gives the same city");
  f.number("lat_deg", c.lat_deg, {-89.0, 89.0}, "latitude of the centre");
  f.number("lon_deg", c.lon_deg, {-180.0, 180.0}, "longitude of the centre");
  f.number("extent_m", c.extent_m, kCityExtent_m, "edge of the square");
  f.number("base_height_m", c.base_height_m, {-400.0, 8000.0}, "ellipsoidal height of the ground at the centre");
  f.number("slope_percent", c.slope_percent, kCitySlope_percent, "mean slope, rising to the north-east");
  f.number("hill_height_m", c.hill_height_m, {0.0, 15.0}, "height of the rolling hills on top of the slope");
  f.number("terrain_cell_m", c.terrain_cell_m, {0.5, 20.0}, "edge of a terrain cell (two triangles)");
  f.number("block_m", c.block_m, kCityBlock_m, "mean distance from street to street");
  f.number("street_width_m", c.street_width_m, {11.0, 20.0}, "kerb to kerb");
  f.number(
      "kerb_height_m", c.kerb_height_m, {0.0, 0.3},
      "by how much pavements are raised; 0: they are painted on the ground; wheels do not feel them, and radio meets "
      "their edges alone");
  f.flag("empty", c.empty, "terrain and streets only: open sky");
  f.flag("absorbing", c.absorbing, "every surface absorbs radio: blockage without reflections");
}

namespace {

/// Buildings, trees and all else; 135,000 to 145,000 were counted in cities of 0.5 to 2 km with blocks of 60 to 200 m.
constexpr double kTrianglesPerKm2 = 145e3;

void paint_ground(const CityConfig& config, const city::Plan& plan, const MeshBuilder& mesh, city::Terrain& terrain) {
  const double half_m = 0.5 * config.extent_m, half_street_m = 0.5 * config.street_width_m;
  terrain.paint(-half_m, -half_m, half_m, half_m, mesh.material("grass"));
  for (const city::Block& block : plan.blocks) {
    const city::Rectangle land = block.kerb.inset(city::kSidewalk_m);
    const bool paved = block.zone == city::Zone::kTall || block.zone == city::Zone::kMiddle;
    terrain.paint(block.kerb.x0, block.kerb.y0, block.kerb.x1, block.kerb.y1, mesh.material("concrete"));
    if (!paved) terrain.paint(land.x0, land.y0, land.x1, land.y1, mesh.material("grass"));
  }
  for (const StreetGraph::Edge& e : plan.streets.edges) {
    const Eigen::Vector2d a = plan.streets.nodes_W[e.a], b = plan.streets.nodes_W[e.b];
    const Eigen::Vector2d low = a.cwiseMin(b).array() - half_street_m, high = a.cwiseMax(b).array() + half_street_m;
    terrain.paint(low.x(), low.y(), high.x(), high.y(), mesh.material("asphalt"));
  }
}

}  // namespace

SceneCost predicted_cost(const CityConfig& config) {
  const double cells = std::max(1.0, std::round(config.extent_m / config.terrain_cell_m));
  const double area_km2 = 1e-6 * config.extent_m * config.extent_m;
  const double pavements = config.kerb_height_m > 0.0 ? city::pavement_triangles(city::make_plan(config)) : 0.0;
  return {2.0 * cells * cells + (config.empty ? 0.0 : kTrianglesPerKm2 * area_km2 + pavements)};
}

SceneParts make_city(const CityConfig& config) {
  SceneParts parts;
  parts.name = "built-in city " + std::to_string(config.seed);
  parts.frame = LocalFrame({config.lat_deg * kDegree, config.lon_deg * kDegree, config.base_height_m});
  parts.materials = builtin_materials();
  if (config.absorbing) {
    for (Material& m : parts.materials) m.rf_absorbing = true;
  }

  const city::Plan plan = city::make_plan(config);
  city::Terrain terrain(config);
  paint_ground(config, plan, MeshBuilder(parts), terrain);
  terrain.add_to(parts);
  parts.streets = plan.streets;
  if (!config.empty) {
    city::add_buildings(config, plan, terrain, parts);
    city::add_vehicles(config, plan, terrain, parts);
    city::add_trees(config, plan, terrain, parts);
    city::add_poles(config, plan, terrain, parts);
    city::add_garden_walls(config, plan, terrain, parts);
    if (config.kerb_height_m > 0.0) city::add_pavements(config, plan, terrain, parts);
  }
  return parts;
}

}  // namespace canyon::scene
