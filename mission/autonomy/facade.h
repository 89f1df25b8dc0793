#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/scene/scene_at.h"

namespace canyon::mission {

/// 5 x 5 points on the wall of `building` that faces `from` best (largest apparent width), 5 cm in front of it.
std::vector<Eigen::Vector3d> facade_points(const scene::Building& building, const Eigen::Vector2d& from_W);

/// Share of the points in sight of `camera_W`.
double visible_share(const scene::SceneAt& scene, const Eigen::Vector3d& camera_W,
                     const std::vector<Eigen::Vector3d>& points_W);

}  // namespace canyon::mission
