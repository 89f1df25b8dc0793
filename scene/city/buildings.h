#pragma once

#include "scene/city/plan.h"
#include "scene/city/terrain.h"

namespace canyon::scene::city {

/// Fills the blocks with buildings, at least kSidewalk_m from every kerb.
void add_buildings(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts);

}  // namespace canyon::scene::city
