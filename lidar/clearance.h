#pragma once

#include <vector>

#include "canyon/core/motion/route_segment.h"
#include "canyon/scene/city/traffic.h"
#include "canyon/scene/scene.h"

namespace canyon::lidar {

/// What stands around a piece of a route: the least horizontal distance from a body's origin in it to anything but
/// terrain (buildings, crowns, the ways of what moves), at most kMost_m, and how steep the terrain is within that.
struct Clearance {
  double clear_m = 0.0;
  double ground_slope = 0.0;  ///< rise over run, of its steepest triangle

  static constexpr double kMost_m = 30.0;
};

std::vector<Clearance> clearances(const scene::Scene& scene, const std::vector<scene::SweptRoom>& moving,
                                  const std::vector<RouteSegment>& route);

}  // namespace canyon::lidar
