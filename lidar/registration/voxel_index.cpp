#include "canyon/lidar/registration/voxel_index.h"

#include <cmath>

#include "canyon/core/check.h"

namespace canyon::lidar {
namespace {

constexpr int kHalf = 1 << 20;  // 21 bits per axis
constexpr std::size_t kFewest = 64;

std::uint64_t key_of(const VoxelCoordinates& v) {
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + kHalf) & 0x1fffffu; };
  return part(v.x()) << 42 | part(v.y()) << 21 | part(v.z());
}

/// splitmix64's finalizer (Steele, Lea and Flood 2014): every bit of the key reaches the low bits, so that neighbouring
/// voxels spread over the table.
std::uint64_t mix(std::uint64_t key) {
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
  return key ^ (key >> 31);
}

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

std::optional<VoxelCoordinates> VoxelIndex::coordinates(const Eigen::Vector3f& p) const {
  VoxelCoordinates voxel;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double scaled = static_cast<double>(p[a]) / leaf_m_;
    if (!(scaled >= 1 - kHalf && scaled < kHalf)) return std::nullopt;  // so also for NaN
    const int towards_zero = static_cast<int>(scaled);
    voxel[a] = towards_zero - (scaled < towards_zero ? 1 : 0);
  }
  return voxel;
}

std::size_t VoxelIndex::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = mix(key) & mask;
  while (slots_[i] != kNone && keys_[slots_[i]] != key) i = (i + 1) & mask;
  return i;
}

std::uint32_t VoxelIndex::insert(const VoxelCoordinates& voxel) {
  const std::uint64_t key = key_of(voxel);
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
  return slots_[slot_of(key_of(voxel))];
}

void VoxelIndex::grow() {
  const std::size_t slots = 2 * slots_.size();
  std::vector<std::uint32_t>().swap(slots_);  // the old ones are not needed beside the new
  slots_.assign(slots, kNone);
  for (std::uint32_t number = 0; number < size(); ++number) slots_[slot_of(keys_[number])] = number;
}

}  // namespace canyon::lidar
