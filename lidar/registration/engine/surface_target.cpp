#include "canyon/lidar/registration/engine/surface_target.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "canyon/lidar/registration/engine/match_form.h"

namespace canyon::lidar {
namespace {

constexpr double kFlat = 1.0 - kSurfaceThickness;
constexpr float kRounding = 1.0F - 1e-5F;  // of distances in single precision, with room

class PointTarget final : public SurfaceTarget {
 public:
  explicit PointTarget(std::shared_ptr<const PreparedCloud> cloud) : cloud_(std::move(cloud)) {
    columns(cloud_->points, cloud_->normals, cloud_->tilt_variance);
  }
  void find(const Eigen::Vector3f& place, float squared_limit, LastMatch& last) const override {
    if (still_the_nearest(place, squared_limit, last)) return;
    const auto found = cloud_->tree->nearest_from(place, squared_limit, last.at);
    last = {found.at, found.at, std::sqrt(found.others_squared_m), place};
  }
  double flat(std::size_t at) const override { return cloud_->normals[at].isZero(0.0f) ? 0.0 : kFlat; }

 private:
  bool still_the_nearest(const Eigen::Vector3f& place, float squared_limit, LastMatch& last) const {
    // The others have come nearer by the way since then at most.
    const float others_m = kRounding * last.others_m - (place - last.place).norm();
    if (!(others_m > 0.0F)) return false;
    if (last.at == LeafTree::kNone) return others_m * others_m >= squared_limit;
    const float there = (cloud_->points[last.at] - place).squaredNorm();
    if (!(there < others_m * others_m)) return false;
    last.matched = there < squared_limit ? last.at : LeafTree::kNone;
    return true;
  }

  std::shared_ptr<const PreparedCloud> cloud_;
};

class VoxelTarget final : public SurfaceTarget {
 public:
  VoxelTarget(const PreparedCloud& cloud, double voxel_m) : voxels_(voxel_m, cloud.points.size() / 4) {
    struct Sum {
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      Eigen::Matrix3d nn = Eigen::Matrix3d::Zero();
      double tilt = 0, count = 0, planes = 0;
    };
    std::vector<Sum> sums;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      const auto voxel = voxels_.coordinates(cloud.points[i]);
      if (!voxel) continue;
      const std::uint32_t number = voxels_.insert(*voxel);
      if (number == sums.size()) sums.emplace_back();
      Sum& sum = sums[number];
      const Eigen::Vector3d n = cloud.normals[i].cast<double>();
      sum.p += cloud.points[i].cast<double>();
      sum.nn += n * n.transpose();
      sum.tilt += cloud.tilt_variance[i];
      sum.count += 1;
      sum.planes += n.isZero(0.0) ? 0 : 1;
    }
    for (const Sum& sum : sums) {
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
      eigen.computeDirect(sum.nn / sum.count);
      const double share = eigen.eigenvalues()[2];
      const bool plane = sum.planes > 0 && share > 0 && eigen.eigenvectors().allFinite();
      points_.push_back((sum.p / sum.count).cast<float>());
      normals_.push_back(plane ? Eigen::Vector3f(eigen.eigenvectors().col(2).cast<float>()) : Eigen::Vector3f::Zero());
      tilt_.push_back(plane ? static_cast<float>(sum.tilt / (sum.planes * sum.planes)) : 0.0f);
      flat_.push_back(plane ? kFlat * std::min(share, 1.0) : 0.0);
    }
    columns(points_, normals_, tilt_);
  }
  void find(const Eigen::Vector3f& place, float squared_limit, LastMatch& last) const override {
    LeafTree::Nearest best{squared_limit, LeafTree::kNone};
    last.matched = LeafTree::kNone;
    const auto voxel = voxels_.coordinates(place);
    if (!voxel) return;
    static const VoxelCoordinates kBeside[] = {{0, 0, 0},  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                                               {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const VoxelCoordinates& beside : kBeside) {
      const std::uint32_t number = voxels_.find(*voxel + beside);
      if (number == VoxelIndex::kNone) continue;
      const float there = (points_[number] - place).squaredNorm();
      if (there < best.squared_m) best = {there, number};
    }
    last.matched = best.at;
  }
  double flat(std::size_t at) const override { return flat_[at]; }

 private:
  VoxelIndex voxels_;
  std::vector<Eigen::Vector3f> points_, normals_;
  std::vector<float> tilt_;
  std::vector<double> flat_;
};

}  // namespace

std::unique_ptr<SurfaceTarget> point_target(std::shared_ptr<const PreparedCloud> cloud) {
  return std::make_unique<PointTarget>(std::move(cloud));
}

std::unique_ptr<SurfaceTarget> voxel_target(const PreparedCloud& cloud, double voxel_m) {
  return std::make_unique<VoxelTarget>(cloud, voxel_m);
}

}  // namespace canyon::lidar
