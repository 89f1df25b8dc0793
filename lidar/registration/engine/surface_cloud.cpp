#include "canyon/lidar/registration/engine/surface_cloud.h"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Eigenvalues>

#include "canyon/core/process/parallel.h"
#include "canyon/lidar/registration/engine/leaf_tree.h"
#include "canyon/lidar/turned.h"
#include "canyon/lidar/voxels/voxel_index.h"
#include "canyon/lidar/voxels/voxel_map.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kNeighbours = 12;
constexpr std::size_t kFewestNeighbours = 6;  // fewer say too little about a plane
constexpr double kReach_leaves = 8.0;         // neighbours farther away belong to another surface
constexpr double kNarrowest = 0.1;            // as in prepared_cloud.cpp: a ring by itself lies in many planes
constexpr std::size_t kChunk = 64;            // leaves

/// Takes the order of the tree for points; other columns are resized.
void put_in_order(PreparedCloud& cloud) {
  const auto tree = std::make_shared<LeafTree>(cloud.points);
  std::vector<Eigen::Vector3f> ordered(cloud.points.size());
  for (std::size_t k = 0; k < ordered.size(); ++k) ordered[k] = cloud.points[tree->order()[k]];
  cloud.points = std::move(ordered);
  cloud.tree = tree;
}

/// The plane through the neighbours of point i, if they form one.
void fit_plane(PreparedCloud& cloud, std::size_t i, std::span<const LeafTree::Nearest> found) {
  const std::size_t count = found.size();
  if (count < kFewestNeighbours) return;
  // About the point itself, so that nothing cancels.
  double sx = 0, sy = 0, sz = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3f d = cloud.points[found[k].at] - cloud.points[i];
    const double x = d.x(), y = d.y(), z = d.z();
    sx += x, sy += y, sz += z;
    xx += x * x, xy += x * y, xz += x * z, yy += y * y, yz += y * z, zz += z * z;
  }
  const auto n = static_cast<double>(count);
  Eigen::Matrix3d scatter;
  scatter << xx - sx * sx / n, xy - sx * sy / n, xz - sx * sz / n, 0, yy - sy * sy / n, yz - sy * sz / n, 0, 0,
      zz - sz * sz / n;
  scatter = scatter.selfadjointView<Eigen::Upper>();
  scatter /= n;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(scatter);
  const Eigen::Vector3d& spread = eigen.eigenvalues();  // ascending
  if (!(spread[1] > kNarrowest * spread[2])) return;
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  if (!normal.allFinite()) return;
  cloud.normals[i] = normal.cast<float>();
  const double residual = std::max(spread[0], 0.0) * n / (n - 3.0);
  cloud.tilt_variance[i] = static_cast<float>(residual / (n * spread[1]));
}

}  // namespace

std::shared_ptr<const PreparedCloud> prepare_surfaces(std::span<const Eigen::Vector3f> points, double leaf_m) {
  const auto cloud = std::make_shared<PreparedCloud>();
  std::vector<Eigen::Vector3f> returns;
  returns.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    if (p != Eigen::Vector3f::Zero()) returns.push_back(p);
  }
  cloud->points = voxel_centroids(returns, leaf_m);
  put_in_order(*cloud);
  cloud->normals.assign(cloud->points.size(), Eigen::Vector3f::Zero());
  cloud->tilt_variance.assign(cloud->points.size(), 0.0f);
  const auto reach_m = static_cast<float>(kReach_leaves * leaf_m);
  parallel_for(cloud->tree->leaves(), kChunk, [&](std::size_t begin, std::size_t end) {
    LeafTree::OfLeaf<kNeighbours> of;
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      cloud->tree->nearest_of_leaf(static_cast<std::uint32_t>(leaf), reach_m * reach_m, of);
      for (std::uint32_t i = of.begin; i < of.end; ++i)
        fit_plane(*cloud, i, std::span(of.nearest[i - of.begin]).first(of.count[i - of.begin]));
    }
  });
  return cloud;
}

std::shared_ptr<const PreparedCloud> unite_surfaces(std::span<const PlacedCloud> clouds, double leaf_m) {
  PreparedCloud all;
  std::size_t most = 0;
  for (const PlacedCloud& each : clouds) most += each.cloud->points.size();
  all.points.reserve(most);
  all.normals.reserve(most);
  all.tilt_variance.reserve(most);
  VoxelIndex voxels(leaf_m, 10000);
  for (std::size_t k = clouds.size(); k-- > 0;) {
    const PreparedCloud& cloud = *clouds[k].cloud;
    const std::uint32_t occupied = voxels.size();
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      const Eigen::Vector3f p = (turned(clouds[k].R, cloud.points[i]) + clouds[k].p).cast<float>();
      const auto voxel = voxels.coordinates(p);
      if (!voxel || voxels.insert(*voxel) < occupied) continue;
      all.points.push_back(p);
      all.normals.push_back(turned(clouds[k].R, cloud.normals[i]).cast<float>());
      all.tilt_variance.push_back(cloud.tilt_variance[i]);
    }
  }
  const auto out = std::make_shared<PreparedCloud>();
  out->points = std::move(all.points);
  put_in_order(*out);
  out->normals.reserve(out->points.size());
  out->tilt_variance.reserve(out->points.size());
  for (const std::uint32_t from : out->tree->order()) {
    out->normals.push_back(all.normals[from]);
    out->tilt_variance.push_back(all.tilt_variance[from]);
  }
  return out;
}

}  // namespace canyon::lidar
