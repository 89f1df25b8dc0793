#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"

namespace canyon::lidar {

/// The points of a map from a file.
struct ReadMap {
  std::vector<Eigen::Vector3f> points;
  std::int64_t not_finite = 0;  ///< that were left out
};
/// Binary PCD with x, y and z, as a run writes its maps.
Result<ReadMap> read_map(const std::string& path);

}  // namespace canyon::lidar
