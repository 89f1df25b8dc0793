#pragma once

#include <memory>
#include <vector>

#include "canyon/lidar/registration/engine/leaf_tree.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/voxel_index.h"

namespace canyon::lidar {

/// What a source is matched to: surface elements, and how the one for a place is found.
class SurfaceTarget {
 public:
  virtual ~SurfaceTarget() = default;
  /// The element of a place, closer than sqrt(squared_limit). `last`: the one found for a place nearby, or kNone; it
  /// makes the search shorter and no other.
  virtual LeafTree::Nearest find(const Eigen::Vector3f& place, float squared_limit, std::uint32_t last) const = 0;

  std::size_t size() const { return points_->size(); }
  const Eigen::Vector3f& point(std::size_t at) const { return (*points_)[at]; }
  const Eigen::Vector3f& normal(std::size_t at) const { return (*normals_)[at]; }
  float tilt_variance(std::size_t at) const { return (*tilt_variance_)[at]; }
  /// 1 - (thickness across) of an element, as in MatchForm.
  virtual double flat(std::size_t at) const = 0;

 protected:
  void columns(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
               const std::vector<float>& tilt_variance) {
    points_ = &points;
    normals_ = &normals;
    tilt_variance_ = &tilt_variance;
  }

 private:
  const std::vector<Eigen::Vector3f>* points_ = nullptr;
  const std::vector<Eigen::Vector3f>* normals_ = nullptr;
  const std::vector<float>* tilt_variance_ = nullptr;
};

/// The cloud's own points, the nearest counts. The cloud has a tree.
std::unique_ptr<SurfaceTarget> point_target(std::shared_ptr<const PreparedCloud> cloud);
/// Means over voxels of `voxel_m`, normals averaged as covariances are (Koide et al. 2021, "Voxelized GICP"): the
/// nearest of the voxel of the place and the six beside it counts.
std::unique_ptr<SurfaceTarget> voxel_target(const PreparedCloud& cloud, double voxel_m);

}  // namespace canyon::lidar
