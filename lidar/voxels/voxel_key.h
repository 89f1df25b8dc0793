#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

namespace canyon::lidar {

/// Integer coordinates of a voxel in a cubic grid; the corner of voxel (0, 0, 0) is at the origin.
using VoxelCoordinates = Eigen::Vector3i;

/// Voxels are told apart within so many of the origin: 21 bits an axis.
inline constexpr int kVoxelReach = 1 << 20;

/// Of the voxel of edge leaf_m > 0 that p lies in; none if p is not finite, or farther than 2^20 voxels from the
/// origin.
inline std::optional<VoxelCoordinates> voxel_coordinates(const Eigen::Vector3f& p, double leaf_m) {
  VoxelCoordinates voxel;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double scaled = static_cast<double>(p[a]) / leaf_m;
    if (!(scaled >= 1 - kVoxelReach && scaled < kVoxelReach)) return std::nullopt;  // so also for NaN
    const int towards_zero = static_cast<int>(scaled);
    voxel[a] = towards_zero - (scaled < towards_zero ? 1 : 0);
  }
  return voxel;
}

/// One number below 2^63 for each voxel within +-2^20 of the origin.
inline std::uint64_t voxel_key(const VoxelCoordinates& v) {
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + kVoxelReach) & 0x1fffffu; };
  return part(v.x()) << 42 | part(v.y()) << 21 | part(v.z());
}

/// A hash of it in which neighbouring voxels are spread over all bits.
inline std::uint64_t spread_key(std::uint64_t key) {
  // splitmix64's finalizer (Steele, Lea and Flood 2014)
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
  return key ^ (key >> 31);
}

}  // namespace canyon::lidar
