#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "canyon/lidar/voxels/voxel_key.h"

namespace canyon::lidar {

/// Numbers the occupied voxels of a cubic grid in the order in which they are first met: 0, 1, 2, ...
/// The numbering depends on the order of insertion only. Coordinates must lie within +-2^20 voxels of the origin.
class VoxelIndex {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// `leaf_m` > 0: edge of a voxel; the corner of voxel (0, 0, 0) is at the origin.
  explicit VoxelIndex(double leaf_m, std::size_t expected_voxels = 0);

  double leaf_m() const { return leaf_m_; }
  /// Voxels met so far.
  std::uint32_t size() const { return static_cast<std::uint32_t>(keys_.size()); }

  /// Of the voxel that p lies in; none if p is not finite or too far out.
  std::optional<VoxelCoordinates> coordinates(const Eigen::Vector3f& p) const { return voxel_coordinates(p, leaf_m_); }
  /// Number of a voxel; a new one if it was not met before.
  std::uint32_t insert(const VoxelCoordinates& voxel);
  /// Number of a voxel, or kNone.
  std::uint32_t find(const VoxelCoordinates& voxel) const;

 private:
  std::size_t slot_of(std::uint64_t key) const;
  void grow();

  double leaf_m_;
  std::vector<std::uint64_t> keys_;   // of the voxels, by number
  std::vector<std::uint32_t> slots_;  // numbers; open addressing, a power of two, at most half full
};

}  // namespace canyon::lidar
