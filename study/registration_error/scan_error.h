#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/scene/scene.h"

namespace canyon::study {

/// Points of a scan within `range_m`, in L, evenly out of its order: enough to say how far off a keyframe puts it.
std::vector<Eigen::Vector3f> sampled_points(const LidarScan& scan, double range_m);

/// Mean square distance of the points, placed at X_WL, to the true surfaces, m^2, capped as the map's figures are
/// (lidar/map_quality/map_error.h): the map's error as far as one keyframe makes it. NaN without points.
double placed_error_m2(const std::vector<Eigen::Vector3f>& points_L, const Pose& X_WL, const scene::Scene& scene);

}  // namespace canyon::study
