#pragma once

#include "canyon/scene/scene.h"

namespace canyon::scene {

/// Streets of a scene that comes without any: the middle lines of the ground that a car can drive on, at least 2.5 m
/// away from whatever stands up to 2.5 m high over the terrain. A grid of 2 m (coarser for scenes over 4 km) is thinned
/// to lines (Zhang & Suen 1984), lines are straightened to 1.5 m, dead ends of less than 25 m and whatever is not
/// connected to the largest part are left out. Empty without terrain.
StreetGraph free_space_streets(const SceneParts& parts);

}  // namespace canyon::scene
