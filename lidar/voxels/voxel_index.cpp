#include "canyon/lidar/voxels/voxel_index.h"

#include <cmath>

#include "canyon/core/check.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kFewest = 64;

std::size_t power_of_two_at_least(std::size_t n) {
  std::size_t power = kFewest;
  while (power < n) power *= 2;
  return power;
}

}  // namespace

VoxelIndex::VoxelIndex(double leaf_m, std::size_t expected_voxels)
    : leaf_m_(leaf_m), slots_(power_of_two_at_least(2 * expected_voxels), kNone) {
  CANYON_CHECK(leaf_m > 0 && std::isfinite(leaf_m), "leaf_m = ", leaf_m);
}

std::size_t VoxelIndex::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = spread_key(key) & mask;
  while (slots_[i] != kNone && keys_[slots_[i]] != key) i = (i + 1) & mask;
  return i;
}

std::uint32_t VoxelIndex::insert(const VoxelCoordinates& voxel) {
  const std::uint64_t key = voxel_key(voxel);
  std::size_t i = slot_of(key);
  if (slots_[i] != kNone) return slots_[i];
  if (2 * (keys_.size() + 1) > slots_.size()) {
    grow();
    i = slot_of(key);
  }
  slots_[i] = size();
  keys_.push_back(key);
  return slots_[i];
}

std::uint32_t VoxelIndex::find(const VoxelCoordinates& voxel) const {
  return slots_[slot_of(voxel_key(voxel))];
}

void VoxelIndex::grow() {
  const std::size_t slots = 2 * slots_.size();
  std::vector<std::uint32_t>().swap(slots_);  // the old ones are not needed beside the new
  slots_.assign(slots, kNone);
  for (std::uint32_t number = 0; number < size(); ++number) slots_[slot_of(keys_[number])] = number;
}

}  // namespace canyon::lidar
