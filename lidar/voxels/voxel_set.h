#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "canyon/lidar/voxels/voxel_key.h"

namespace canyon::lidar {

/// Which voxels have been met, in 10 to 12.5 bytes a voxel and hardly more while it grows: a map of a long drive has
/// millions.
class VoxelSet {
 public:
  /// True if the voxel was not met before; `key` is its voxel_key().
  bool insert(std::uint64_t key);
  /// Has the memory of where that will be looked for brought near.
  void fetch(std::uint64_t key) const;

 private:
  /// Open addressing; kEmpty where there is no key.
  struct Shard {
    std::vector<std::uint64_t> slots;
    std::size_t count = 0;
  };
  static std::size_t slot_of(const Shard& shard, std::uint64_t hash);
  static bool put(Shard& shard, std::uint64_t key);
  static void grow(Shard& shard);

  std::array<Shard, 64> shards_;  // each grows alone, so that little stands twice
};

}  // namespace canyon::lidar
