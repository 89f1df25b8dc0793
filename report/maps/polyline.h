#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace canyon::report {

/// Indices of the vertices that keep the polyline within `tolerance_m` of the original (Douglas & Peucker 1973); the
/// first and the last always stay. A polyline that returns over itself keeps its turning points.
std::vector<std::size_t> simplify_polyline(const std::vector<Eigen::Vector2d>& points, double tolerance_m);

}  // namespace canyon::report
