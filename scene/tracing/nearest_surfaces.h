#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/scene/scene_at.h"

namespace canyon::scene {

/// SceneAt::nearest() of many points at once, with the same answers: the ray tracer's tree is made for rays, and points
/// that lie close together need the same triangles. Points must be finite, max_m >= 0. The same bits for any number of
/// threads; threads share the work.
std::vector<NearestSurface> nearest_surfaces(const Scene& scene, std::span<const Eigen::Vector3f> points_W,
                                             double max_m);

}  // namespace canyon::scene
