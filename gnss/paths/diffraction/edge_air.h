#pragma once

#include <Eigen/Core>

#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/edge.h"

namespace canyon::gnss {

inline constexpr double kOffEdge_m =
    0.03;  ///< legs meet an edge this far outside, beyond the rounding of single precision
inline constexpr double kEdgeProbe_m = 0.3;  ///< a true edge has this much air around it

/// Is this an edge of the whole at that point of it, and not one that a neighbour continues (row houses of one height)?
bool ends_in_air(const scene::Edge& edge, const Eigen::Vector3d& point_W, const scene::SceneAt& scene);

}  // namespace canyon::gnss
