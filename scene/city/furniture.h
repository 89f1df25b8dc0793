#pragma once

#include "canyon/scene/city/plan.h"
#include "canyon/scene/city/terrain.h"

namespace canyon::scene::city {

/// Parked vehicles: 4.5 x 1.8 x 1.5 m, within 2 m of the kerb, so that the middle of the street stays free.
void add_vehicles(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts);
/// Street trees between kerb and facade (crowns start above 2.5 m), and trees of parks and gardens. After the
/// buildings.
void add_trees(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts);
/// Lamp poles beside the kerbs.
void add_poles(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts);
/// Garden walls along the sidewalk of blocks with houses, each with a gap for a gate.
void add_garden_walls(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts);
/// Pavements, raised over the street, around every block; radio passes them by.
void add_pavements(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts);
double pavement_triangles(const Plan& plan);

}  // namespace canyon::scene::city
