#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "canyon/lidar/files/cloud_files.h"
#include "canyon/lidar/registration/voxel_index.h"

namespace canyon::lidar {

/// A growing map cloud thinned to one point per voxel: the first to come stays, as it was measured. Deterministic.
class VoxelMap {
 public:
  /// `leaf_m` > 0: edge of a voxel.
  explicit VoxelMap(double leaf_m) : index_(leaf_m) {}

  /// True if the point was kept. One that is not finite, or farther than 2^20 voxels from the origin, is only counted.
  bool insert(const MapPoint& point);
  std::int64_t out_of_reach() const { return out_of_reach_; }

  const std::vector<MapPoint>& points() const { return points_; }
  std::vector<MapPoint> take() && { return std::move(points_); }

 private:
  VoxelIndex index_;
  std::vector<MapPoint> points_;
  std::int64_t out_of_reach_ = 0;
};

/// The centroid of the points in each voxel, in the order in which the voxels are first met. Points that are not
/// finite, or farther than 2^20 voxels from the origin, are left out.
std::vector<Eigen::Vector3f> voxel_centroids(std::span<const Eigen::Vector3f> points, double leaf_m);

}  // namespace canyon::lidar
