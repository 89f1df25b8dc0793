#pragma once

#include "canyon/scene/city/plan.h"
#include "canyon/scene/city/terrain.h"

namespace canyon::scene::city {

/// Names and outlines of the buildings that add_buildings() makes, in its order: what is known before there is ground
/// to stand on.
std::vector<Building> planned_buildings(const CityConfig& config, const Plan& plan);

/// Fills the blocks with buildings, at least kSidewalk_m from every kerb.
void add_buildings(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts);

}  // namespace canyon::scene::city
