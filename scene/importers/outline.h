#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// The rings in which some triangles end: corners at the same place (to a millimetre) count as one. Each ring runs as
/// its triangles do; open chains are left out. In a fixed order.
std::vector<std::vector<Eigen::Vector3d>> border_rings(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles);

/// Counter-clockwise corners of the smallest convex polygon around points.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

}  // namespace canyon::scene
