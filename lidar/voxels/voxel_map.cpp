#include "canyon/lidar/voxels/voxel_map.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {

VoxelMap::VoxelMap(double leaf_m) : leaf_m_(leaf_m) {
  CANYON_CHECK(leaf_m > 0 && std::isfinite(leaf_m), "leaf_m = ", leaf_m);
}

bool VoxelMap::insert(const MapPoint& point) {
  const auto voxel = voxel_coordinates(point.p_W, leaf_m_);
  if (!voxel) {
    ++out_of_reach_;
    return false;
  }
  if (!voxels_.insert(*voxel)) return false;
  cloud_.push_back(point);
  return true;
}

std::vector<Eigen::Vector3f> voxel_centroids(std::span<const Eigen::Vector3f> points, double leaf_m) {
  struct Sum {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
  };
  VoxelIndex index(leaf_m, points.size() / 4);
  std::vector<Sum> sums;
  for (const Eigen::Vector3f& p : points) {
    const auto voxel = index.coordinates(p);
    if (!voxel) continue;
    const std::uint32_t number = index.insert(*voxel);
    if (number == sums.size()) sums.emplace_back();
    sums[number].sum += p.cast<double>();
    ++sums[number].count;
  }
  std::vector<Eigen::Vector3f> centroids;
  centroids.reserve(sums.size());
  for (const Sum& s : sums) centroids.push_back((s.sum / s.count).cast<float>());
  return centroids;
}

}  // namespace canyon::lidar
