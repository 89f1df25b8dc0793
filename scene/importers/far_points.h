#pragma once

#include <vector>

#include "canyon/core/result.h"
#include "canyon/scene/importers/raw_scene.h"

namespace canyon::scene {

/// No scene reaches farther than this from its middle: the plane of W lies 800 m above the Earth there, and single
/// precision steps by 8 mm.
inline constexpr double kSceneReach_m = 100e3;

/// Refuses a corner farther than kSceneReach_m from the median of all corners, by its file and line: one digit too many
/// must neither cost hours nor move the scene. What is not finite is passed over. In W.
Status refuse_far_points(const std::vector<RawScene>& scenes);

}  // namespace canyon::scene
