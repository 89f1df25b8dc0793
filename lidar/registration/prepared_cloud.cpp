#include "canyon/lidar/registration/prepared_cloud.h"

#include <algorithm>
#include <array>

#include <Eigen/Eigenvalues>

#include "canyon/lidar/registration/neighbour_tree.h"
#include "canyon/lidar/voxels/voxel_map.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kNeighbours = 20;       // Segal, Haehnel and Thrun 2009, section IV
constexpr std::size_t kFewestNeighbours = 8;  // fewer say too little about a plane
constexpr double kReach_leaves = 8.0;         // neighbours farther away belong to another surface
// Far from the sensor the neighbours of a point are all of its own ring. Such a line lies in many planes, and the one
// that noise picks must not count: the patch must be at least 0.3 times as wide as it is long (variances 0.1 : 1).
constexpr double kNarrowest = 0.1;

}  // namespace

PreparedCloud prepare_cloud(std::span<const Eigen::Vector3f> points, double leaf_m) {
  PreparedCloud cloud;
  std::vector<Eigen::Vector3f> returns;
  returns.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    if (p != Eigen::Vector3f::Zero()) returns.push_back(p);
  }
  cloud.points = voxel_centroids(returns, leaf_m);
  cloud.normals.assign(cloud.points.size(), Eigen::Vector3f::Zero());
  cloud.tilt_variance.assign(cloud.points.size(), 0.0f);
  const NeighbourTree tree(cloud.points);
  const auto reach_m = static_cast<float>(kReach_leaves * leaf_m);
  std::array<NeighbourTree::Neighbour, kNeighbours> found;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::size_t count = tree.nearest(cloud.points[i], reach_m, found);
    if (count < kFewestNeighbours) continue;
    // About the point itself, so that nothing cancels.
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const auto& neighbour : std::span(found).first(count)) {
      const Eigen::Vector3d d = (cloud.points[neighbour.index] - cloud.points[i]).cast<double>();
      sum += d;
      squares += d * d.transpose();
    }
    const auto n = static_cast<double>(count);
    const Eigen::Matrix3d scatter = squares / n - (sum / n) * (sum / n).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
    const Eigen::Vector3d& spread = eigen.eigenvalues();  // ascending
    if (!(spread[1] > kNarrowest * spread[2])) continue;
    cloud.normals[i] = eigen.eigenvectors().col(0).cast<float>();
    // Residual variance over n - 3 degrees of freedom; slope of a line fit along the narrower direction of the patch.
    const double residual = std::max(spread[0], 0.0) * n / (n - 3.0);
    cloud.tilt_variance[i] = static_cast<float>(residual / (n * spread[1]));
  }
  return cloud;
}

}  // namespace canyon::lidar
