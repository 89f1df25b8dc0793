#pragma once

#include <memory>

#include "canyon/core/process/library_part.h"
#include "canyon/lidar/registration/registration.h"

namespace canyon::lidar {

/// What stands on PCL (core/process/library_part.h).
struct PclPart {
  std::unique_ptr<Registration> (*make_shell_gicp)(const MatchingParameters& config);
  std::unique_ptr<Registration> (*make_icp_normals)(const MatchingParameters& config);
  std::unique_ptr<Registration> (*make_gicp)(const MatchingParameters& config);
  std::unique_ptr<Registration> (*make_ndt)(const MatchingParameters& config);
};

// PCL's own methods as their users know them (pcl_untouched.cpp).
std::unique_ptr<Registration> untouched_pcl_icp_normals(const MatchingParameters& config);
std::unique_ptr<Registration> untouched_pcl_gicp(const MatchingParameters& config);
std::unique_ptr<Registration> untouched_pcl_ndt(const MatchingParameters& config);

extern "C" [[gnu::weak]] const PclPart canyon_pcl_part;

}  // namespace canyon::lidar
