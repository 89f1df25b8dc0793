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
/// Any cloud that read_cloud() reads, of places in W; what is 1e7 m away or more is left out with what is not finite.
Result<ReadMap> read_map(const std::string& path);
/// The same of a map to be registered onto; an Error too where all of it lies over 50 km from W's origin, as it does in
/// coordinates of a country's grid.
Result<ReadMap> read_prior_map(const std::string& path);

}  // namespace canyon::lidar
