#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"

namespace canyon {

/// A piece of the planned route and the room around it in which the vehicle is expected: what a model states of its
/// need (core/need.h) holds while the body's origin is in there, wherever in it and whatever way the body heads, as
/// long as it is tilted by no more than a ground vehicle is.
struct RouteSegment {
  /// Between the body's z axis and W's, rad: a street of 40 % and suspension travel on it.
  static constexpr double kMostTilt_rad = 0.45;

  std::vector<Eigen::Vector3d> points_W;  ///< polyline of B's origin, m; at least one point
  double start_m = 0.0, end_m = 0.0;      ///< arc length along the route
  double half_width_m = 0.0;              ///< horizontal distance from the polyline, >= 0
  double low_m = 0.0, high_m = 0.0;       ///< heights in W

  /// Horizontal distance from the polyline, m.
  double distance_m(const Eigen::Vector2d& p_W) const;
  bool contains(const Pose& X_WB) const;
};

}  // namespace canyon
