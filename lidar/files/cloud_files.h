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
/// Binary PCD that has x, y, z in single precision
/// (https://pointclouds.org/documentation/tutorials/pcd_file_format.html); other fields than the five are passed over,
/// what stands behind the last point too. Points that are not finite, as PCL marks missing returns, are kept. Text,
/// compressed data and damaged headers are errors.
Result<std::vector<MapPoint>> read_pcd(const std::string& path);

}  // namespace canyon::lidar
