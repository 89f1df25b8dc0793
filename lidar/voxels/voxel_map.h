#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "canyon/lidar/files/map_cloud.h"
#include "canyon/lidar/voxels/voxel_set.h"

namespace canyon::lidar {

/// A growing map cloud thinned to one point per voxel: the first to come stays, as it was measured. Deterministic.
/// About 27 bytes a voxel, without a copy while it grows.
class VoxelMap {
 public:
  /// `leaf_m` > 0: edge of a voxel.
  explicit VoxelMap(double leaf_m);

  /// In order. One that is not finite, or farther than 2^20 voxels from the origin, is only counted.
  void insert(std::span<const MapPoint> points);
  /// True if the point was kept.
  bool insert(const MapPoint& point);
  std::int64_t out_of_reach() const { return out_of_reach_; }

  std::size_t size() const { return cloud_.size(); }
  /// The points in the order in which they came.
  MapCloud take() && { return std::move(cloud_); }

 private:
  double leaf_m_;
  VoxelSet voxels_;
  MapCloud cloud_;
  std::int64_t out_of_reach_ = 0;
};

/// The centroid of the points in each voxel, in the order in which the voxels are first met. Points that are not
/// finite, or farther than 2^20 voxels from the origin, are left out.
std::vector<Eigen::Vector3f> voxel_centroids(std::span<const Eigen::Vector3f> points, double leaf_m);

}  // namespace canyon::lidar
