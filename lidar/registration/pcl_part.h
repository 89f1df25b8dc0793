#pragma once

#include <memory>

#include "canyon/core/process/library_part.h"
#include "canyon/lidar/registration/registration.h"

namespace canyon::lidar {

/// What stands on PCL (core/process/library_part.h).
struct PclPart {
  std::unique_ptr<Registration> (*make_gicp)(const MatchingParameters& config);
};
extern "C" [[gnu::weak]] const PclPart canyon_pcl_part;

}  // namespace canyon::lidar
