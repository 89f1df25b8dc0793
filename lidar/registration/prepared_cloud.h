#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace canyon::lidar {

class LeafTree;

/// A cloud made ready for registration, in its own frame: thinned, each point with the plane its neighbours form.
class PreparedCloud {
 public:
  std::vector<Eigen::Vector3f> points;
  /// Unit normal of the surface at the point, sign arbitrary; zero where the neighbours do not form a plane.
  std::vector<Eigen::Vector3f> normals;
  /// 1-sigma squared of the normal's tilt, rad^2, from the scatter of the neighbours about the plane.
  std::vector<float> tilt_variance;
  /// Of the points, which then stand in its order; none where the method has no use for it.
  std::shared_ptr<const LeafTree> tree;
};

/// Thins to one centroid per voxel of leaf_m and fits a plane to the 20 nearest neighbours of each point. Points that
/// are not finite, farther than 2^20 voxels from the origin, or exactly (0, 0, 0) as some sensors mark a missing
/// return, are left out.
PreparedCloud prepare_cloud(std::span<const Eigen::Vector3f> points, double leaf_m);

}  // namespace canyon::lidar
