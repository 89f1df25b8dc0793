#include "canyon/lidar/registration/submap.h"

#include <limits>
#include <utility>

#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {
namespace {

/// Of what lies too far out to have a voxel.
const VoxelCoordinates kNowhere = VoxelCoordinates::Constant(std::numeric_limits<int>::max());

std::vector<VoxelCoordinates> voxels_of(const PreparedCloud& cloud, const Pose& X_OC, double leaf_m) {
  const Eigen::Matrix3d R = X_OC.R.toRotationMatrix();
  std::vector<VoxelCoordinates> out;
  out.reserve(cloud.points.size());
  for (const Eigen::Vector3f& p : cloud.points)
    out.push_back(voxel_coordinates((R * p.cast<double>() + X_OC.p).cast<float>(), leaf_m).value_or(kNowhere));
  return out;
}

/// Only these, in order; a column that the method does not fill stays empty.
template <class Column>
void leave(Column& column, const std::vector<std::size_t>& these) {
  if (column.empty()) return;
  for (std::size_t k = 0; k < these.size(); ++k) column[k] = column[these[k]];
  column.resize(these.size());
}

}  // namespace

void Submap::add(std::shared_ptr<const PreparedCloud> cloud, const Pose& X_OC) {
  Held held{.cloud = std::move(cloud), .own = nullptr, .X_OC = X_OC, .voxels = {}};
  if (held_.size() == most_) held_.pop_front();
  if (leaf_m_ > 0.0) {
    held.voxels = voxels_of(*held.cloud, X_OC, leaf_m_);
    VoxelIndex taken(leaf_m_, held.voxels.size());
    for (const VoxelCoordinates& voxel : held.voxels)
      if (voxel != kNowhere) taken.insert(voxel);
    for (Held& older : held_) leave_out(taken, older);
  }
  held_.push_back(std::move(held));
}

void Submap::leave_out(const VoxelIndex& taken, Held& held) const {
  std::vector<std::size_t> stay;
  stay.reserve(held.voxels.size());
  for (std::size_t i = 0; i < held.voxels.size(); ++i)
    if (held.voxels[i] == kNowhere || taken.find(held.voxels[i]) == VoxelIndex::kNone) stay.push_back(i);
  if (stay.size() == held.voxels.size()) return;
  if (!held.own) {
    held.own = std::make_shared<PreparedCloud>(*held.cloud);
    held.own->tree = nullptr;
    held.cloud = held.own;
  }
  leave(held.own->points, stay);
  leave(held.own->normals, stay);
  leave(held.own->tilt_variance, stay);
  leave(held.voxels, stay);
}

std::vector<Registration::Placed> Submap::in(const Pose& X_TO) const {
  std::vector<Registration::Placed> out;
  out.reserve(held_.size());
  for (const Held& held : held_) out.push_back({held.cloud, X_TO * held.X_OC});
  return out;
}

}  // namespace canyon::lidar
