#pragma once

#include "scene/city/plan.h"
#include "scene/city/terrain.h"

namespace canyon::scene::city {

/// Parked vehicles along the kerbs (their bodies within 2 m of the kerb, so that the middle stays free), street and
/// park trees, lamp poles, garden walls. Buildings must be in place.
void add_furniture(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts);

}  // namespace canyon::scene::city
