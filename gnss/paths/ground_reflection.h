#pragma once

#include <span>

#include "canyon/gnss/paths/path_model.h"

namespace canyon::gnss {

/// Adds the single reflection off the terrain to each satellite's echoes (not sorted). The terrain reflects as the
/// plane that fits it over the first Fresnel zone (radius across sqrt(wavelength x height / sin(elevation)), 0.3 m to
/// 10 m) around the reflection point, which is found by iteration; where it is not found in 30 steps (a rough edge, a
/// slope that turns away) there is none. Both legs are tested for obstacles. No terrain under the antenna, or an
/// antenna below it: no reflection.
void add_ground_reflections(const PathParameters& p, const Eigen::Vector3d& p_A_W, const PlaneWaves& waves,
                            const scene::SceneAt& scene, std::span<SignalPaths> out, GnssCounters& counters);

}  // namespace canyon::gnss
