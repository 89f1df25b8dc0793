#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

namespace canyon::lidar {

/// Integer coordinates of a voxel in a cubic grid; the corner of voxel (0, 0, 0) is at the origin.
using VoxelCoordinates = Eigen::Vector3i;

/// Of the voxel of edge leaf_m > 0 that p lies in; none if p is not finite, or farther than 2^20 voxels from the
/// origin.
std::optional<VoxelCoordinates> voxel_coordinates(const Eigen::Vector3f& p, double leaf_m);

/// One number below 2^63 for each voxel within +-2^20 of the origin.
std::uint64_t voxel_key(const VoxelCoordinates& v);

/// A hash of it in which neighbouring voxels are spread over all bits.
std::uint64_t spread_key(std::uint64_t key);

}  // namespace canyon::lidar
