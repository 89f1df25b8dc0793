#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"

namespace canyon::lidar {

/// A point of a map cloud, in W.
struct MapPoint {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();
  float intensity = 0;
  float error_m = 0;  ///< distance to the nearest true surface (scorer's)
};

/// Binary PCD v0.7 with fields x y z intensity error.
Status write_pcd(const std::string& path, std::span<const MapPoint> points);

}  // namespace canyon::lidar
