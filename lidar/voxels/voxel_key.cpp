#include "canyon/lidar/voxels/voxel_key.h"

namespace canyon::lidar {
namespace {

constexpr int kReach = 1 << 20;  // 21 bits per axis

}  // namespace

std::optional<VoxelCoordinates> voxel_coordinates(const Eigen::Vector3f& p, double leaf_m) {
  VoxelCoordinates voxel;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double scaled = static_cast<double>(p[a]) / leaf_m;
    if (!(scaled >= 1 - kReach && scaled < kReach)) return std::nullopt;  // so also for NaN
    const int towards_zero = static_cast<int>(scaled);
    voxel[a] = towards_zero - (scaled < towards_zero ? 1 : 0);
  }
  return voxel;
}

std::uint64_t voxel_key(const VoxelCoordinates& v) {
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + kReach) & 0x1fffffu; };
  return part(v.x()) << 42 | part(v.y()) << 21 | part(v.z());
}

std::uint64_t spread_key(std::uint64_t key) {
  // splitmix64's finalizer (Steele, Lea and Flood 2014)
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
  return key ^ (key >> 31);
}

}  // namespace canyon::lidar
