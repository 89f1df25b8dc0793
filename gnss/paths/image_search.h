#pragma once

#include <span>

#include "canyon/gnss/paths/path_model.h"

namespace canyon::gnss {

/// Adds all ways with 1 to `order` (up to SignalPath::kMaxReflections) specular reflections to `out`, whose
/// line_of_sight must be known; echoes are not sorted. Beside a facet's border a wave is followed up to `largest_nu` of
/// a thin screen's edge (largest_border_nu; 0: borders are sharp). See make_specular1.
void find_images(int order, const PathParameters& p, double largest_nu, const Eigen::Vector3d& p_A_W,
                 const PlaneWaves& waves, const scene::SceneAt& scene, std::span<SignalPaths> out,
                 GnssCounters& counters);

}  // namespace canyon::gnss
