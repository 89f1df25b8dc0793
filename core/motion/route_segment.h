#pragma once

#include <algorithm>
#include <cmath>
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
  double distance_m(const Eigen::Vector2d& p_W) const {
    double least_m = (p_W - points_W.front().head<2>()).norm();
    for (std::size_t i = 1; i < points_W.size(); ++i) {
      const Eigen::Vector2d a = points_W[i - 1].head<2>(), along = points_W[i].head<2>() - a;
      const double square = along.squaredNorm();
      const double share = square > 0.0 ? std::clamp((p_W - a).dot(along) / square, 0.0, 1.0) : 0.0;
      least_m = std::min(least_m, (p_W - a - share * along).norm());
    }
    return least_m;
  }
  bool contains(const Pose& X_WB) const {
    const Eigen::Vector3d& p = X_WB.p;
    const double cos_tilt = (X_WB.R * Eigen::Vector3d::UnitZ()).z();
    return cos_tilt >= std::cos(kMostTilt_rad) && p.z() >= low_m && p.z() <= high_m &&
           distance_m(p.head<2>()) <= half_width_m;
  }
};

}  // namespace canyon
