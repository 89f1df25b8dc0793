#pragma once

#include <memory>
#include <vector>

#include "canyon/lidar/registration/engine/leaf_tree.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {

/// What the search for a point's element leaves behind for the next one, a little way on.
struct LastMatch {
  std::uint32_t matched = LeafTree::kNone;  ///< what was found, in reach
  std::uint32_t at = LeafTree::kNone;       ///< the nearest, in reach or not
  float others_m = 0.0F;                    ///< from `place` all other elements are at least so far
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
};

/// What a source is matched to: surface elements, and how the one for a place is found.
class SurfaceTarget {
 public:
  virtual ~SurfaceTarget() = default;
  /// Finds the element of a place, closer than sqrt(squared_limit), or kNone: last.matched. What `last` holds of a
  /// place nearby makes the search shorter or needless, and its result no other.
  virtual void find(const Eigen::Vector3f& place, float squared_limit, LastMatch& last) const = 0;

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
