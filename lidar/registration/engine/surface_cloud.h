#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

#include "canyon/lidar/registration/prepared_cloud.h"

namespace canyon::lidar {

/// Thins to one centroid per voxel of leaf_m, orders the points by the leaves of their tree, and fits a plane to the 12
/// nearest neighbours of each, in closed form. Which points are left out is said of prepare_cloud(). The same bits for
/// any number of threads.
std::shared_ptr<const PreparedCloud> prepare_surfaces(std::span<const Eigen::Vector3f> points, double leaf_m);

/// Clouds placed in one frame as a single one with its tree: where they overlap, a voxel of leaf_m belongs to the cloud
/// given last, normally the newest and thus best placed. What lies beyond 2^20 voxels of the frame's origin is left
/// out.
struct PlacedCloud {
  const PreparedCloud* cloud;
  Eigen::Matrix3d R;  ///< of the cloud in the frame
  Eigen::Vector3d p;
};
std::shared_ptr<const PreparedCloud> unite_surfaces(std::span<const PlacedCloud> clouds, double leaf_m);

}  // namespace canyon::lidar
