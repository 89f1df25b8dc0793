#include "canyon/lidar/voxels/voxel_set.h"

namespace canyon::lidar {
namespace {

constexpr std::uint64_t kEmpty = ~0ULL;  // no key is
constexpr std::size_t kFirstSlots = 64;

}  // namespace

bool VoxelSet::insert(std::uint64_t key) {
  Shard& shard = shards_[spread_key(key) >> 58];
  if (5 * (shard.count + 1) > 4 * shard.slots.size()) grow(shard);
  return put(shard, key);
}

void VoxelSet::fetch(std::uint64_t key) const {
  const std::uint64_t hash = spread_key(key);
  const Shard& shard = shards_[hash >> 58];
  if (!shard.slots.empty()) __builtin_prefetch(shard.slots.data() + slot_of(shard, hash));
}

/// The low half of the hash, as a share of all slots: their number need not be a power of two.
std::size_t VoxelSet::slot_of(const Shard& shard, std::uint64_t hash) {
  return (hash & 0xffffffffu) * shard.slots.size() >> 32;
}

bool VoxelSet::put(Shard& shard, std::uint64_t key) {
  std::size_t i = slot_of(shard, spread_key(key));
  while (shard.slots[i] != kEmpty) {
    if (shard.slots[i] == key) return false;
    if (++i == shard.slots.size()) i = 0;
  }
  shard.slots[i] = key;
  ++shard.count;
  return true;
}

void VoxelSet::grow(Shard& shard) {
  Shard larger;
  larger.slots.assign(shard.slots.empty() ? kFirstSlots : shard.slots.size() + shard.slots.size() / 4, kEmpty);
  for (const std::uint64_t key : shard.slots)
    if (key != kEmpty) put(larger, key);
  shard = std::move(larger);
}

}  // namespace canyon::lidar
