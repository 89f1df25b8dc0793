#include "canyon/lidar/voxels/voxel_map.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {

VoxelMap::VoxelMap(double leaf_m) : leaf_m_(leaf_m) {
  CANYON_CHECK(leaf_m > 0 && std::isfinite(leaf_m), "leaf_m = ", leaf_m);
}

bool VoxelMap::insert(const MapPoint& point) {
  const std::size_t before = size();
  insert(std::span(&point, 1));
  return size() > before;
}

void VoxelMap::insert(std::span<const MapPoint> points) {
  // What is looked for lies anywhere in tens of megabytes: some are asked for before the first is needed.
  constexpr std::size_t kTogether = 16;
  constexpr std::uint64_t kNone = ~0ULL;  // no key is
  std::uint64_t keys[kTogether];
  for (std::size_t begin = 0; begin < points.size(); begin += kTogether) {
    const std::size_t count = std::min(kTogether, points.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const auto voxel = voxel_coordinates(points[begin + k].p_W, leaf_m_);
      keys[k] = voxel ? voxel_key(*voxel) : kNone;
      if (voxel) voxels_.fetch(keys[k]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (keys[k] == kNone) {
        ++out_of_reach_;
      } else if (voxels_.insert(keys[k])) {
        cloud_.push_back(points[begin + k]);
      }
    }
  }
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
