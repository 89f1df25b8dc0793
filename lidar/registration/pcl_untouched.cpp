// PCL's own registrations, as their users know them: nothing of it is changed but what they are asked to do.
#include <cmath>

#include <pcl/console/print.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>

#include "canyon/lidar/registration/pcl_part.h"
#include "canyon/lidar/registration/prepared_cloud.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kFewestOfPcl = 50;
constexpr double kFarthestOfPcl_m = 1e7;  // PCL computes in single precision

template <class Point>
typename pcl::PointCloud<Point>::Ptr cloud_of(const std::vector<Eigen::Vector3f>& points) {
  auto cloud = pcl::make_shared<pcl::PointCloud<Point>>();
  cloud->reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    Point q;
    q.x = p.x(), q.y = p.y(), q.z = p.z();
    cloud->push_back(q);
  }
  return cloud;
}

pcl::PointCloud<pcl::PointNormal>::Ptr with_normals(const std::vector<Eigen::Vector3f>& points) {
  auto cloud = cloud_of<pcl::PointNormal>(points);
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(20);
  estimation.compute(*cloud);
  auto usable = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  for (const auto& p : *cloud) {
    if (std::isfinite(p.normal_x)) usable->push_back(p);
  }
  return usable;
}

/// What differs between the three: how two clouds become a pose. Clouds are in the frame of the guess, so the guess is
/// the identity and single precision is spent on the correction.
using Solve = bool (*)(const MatchingParameters&, const std::vector<Eigen::Vector3f>& source,
                       const std::vector<Eigen::Vector3f>& target, Eigen::Matrix4d& X, int& rounds);

bool icp_normals(const MatchingParameters& own, const std::vector<Eigen::Vector3f>& source,
                 const std::vector<Eigen::Vector3f>& target, Eigen::Matrix4d& X, int& rounds) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setMaxCorrespondenceDistance(own.max_correspondence_m);
  icp.setMaximumIterations(static_cast<int>(own.max_iterations));
  icp.setTransformationEpsilon(1e-8);
  icp.setInputSource(with_normals(source));
  icp.setInputTarget(with_normals(target));
  pcl::PointCloud<pcl::PointNormal> aligned;
  icp.align(aligned);
  X = icp.getFinalTransformation().cast<double>();
  rounds = static_cast<int>(own.max_iterations);
  return icp.hasConverged();
}

bool gicp(const MatchingParameters& own, const std::vector<Eigen::Vector3f>& source,
          const std::vector<Eigen::Vector3f>& target, Eigen::Matrix4d& X, int&) {
  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setMaxCorrespondenceDistance(own.max_correspondence_m);
  icp.setMaximumIterations(static_cast<int>(own.max_iterations));
  icp.setInputSource(cloud_of<pcl::PointXYZ>(source));
  icp.setInputTarget(cloud_of<pcl::PointXYZ>(target));
  pcl::PointCloud<pcl::PointXYZ> aligned;
  icp.align(aligned);
  X = icp.getFinalTransformation().cast<double>();
  return icp.hasConverged();
}

bool ndt(const MatchingParameters& own, const std::vector<Eigen::Vector3f>& source,
         const std::vector<Eigen::Vector3f>& target, Eigen::Matrix4d& X, int& rounds) {
  pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setResolution(static_cast<float>(own.max_correspondence_m));
  icp.setMaximumIterations(static_cast<int>(own.max_iterations));
  icp.setStepSize(0.1);
  icp.setTransformationEpsilon(0.001);
  icp.setInputSource(cloud_of<pcl::PointXYZ>(source));
  icp.setInputTarget(cloud_of<pcl::PointXYZ>(target));
  pcl::PointCloud<pcl::PointXYZ> aligned;
  icp.align(aligned);
  X = icp.getFinalTransformation().cast<double>();
  rounds = icp.getFinalNumIteration();
  return icp.hasConverged();
}

class UntouchedPcl final : public Registration {
 public:
  UntouchedPcl(Solve solve, const MatchingParameters& own) : solve_(solve), own_(own) {
    // Of a cloud that it cannot align PCL tells the terminal; here the status says it.
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }

  std::shared_ptr<const PreparedCloud> prepare(std::span<const Eigen::Vector3f> points) const override {
    auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    // PCL numbers voxels with 32 bits: what its grid cannot hold would come back unthinned.
    for (const Eigen::Vector3f& p : points) {
      if (p.allFinite() && p.cwiseAbs().maxCoeff() < 1e5f && p != Eigen::Vector3f::Zero())
        cloud->push_back({p.x(), p.y(), p.z()});
    }
    pcl::PointCloud<pcl::PointXYZ> thinned;
    pcl::VoxelGrid<pcl::PointXYZ> grid;
    const auto leaf_m = static_cast<float>(own_.leaf_m);
    grid.setLeafSize(leaf_m, leaf_m, leaf_m);
    grid.setInputCloud(cloud);
    if (!cloud->empty()) grid.filter(thinned);
    const auto out = std::make_shared<PreparedCloud>();
    for (const auto& p : thinned) out->points.emplace_back(p.x, p.y, p.z);
    return out;
  }

  RegistrationResult align(const PreparedCloud& source, std::span<const Placed> targets,
                           const Pose& guess) const override {
    RegistrationResult result;
    result.X_TS = guess;
    result.pcl_objects = 5;
    result.status = RegistrationStatus::kDiverged;
    if (!guess.matrix().allFinite()) return result;
    result.status = RegistrationStatus::kTooFewPoints;
    std::vector<Eigen::Vector3f> target;
    for (const Placed& placed : targets) {
      const Pose X_GC = guess.inverse() * placed.X_TC;
      if (!(X_GC.matrix().array().abs() < kFarthestOfPcl_m).all()) continue;
      const Eigen::Matrix3d R = X_GC.R.toRotationMatrix();
      for (const Eigen::Vector3f& p : placed.cloud->points)
        target.push_back((R * p.cast<double>() + X_GC.p).cast<float>());
    }
    if (source.points.size() < kFewestOfPcl || target.size() < kFewestOfPcl) return result;
    Eigen::Matrix4d X;
    int rounds = 0;
    const bool converged = solve_(own_, source.points, target, X, rounds);
    result.iterations = rounds;
    result.status = RegistrationStatus::kDiverged;
    if (!X.allFinite()) return result;
    result.X_TS = guess * Pose::from_matrix(X);
    result.status = converged ? RegistrationStatus::kConverged : RegistrationStatus::kNotConverged;
    return result;
  }

 private:
  Solve solve_;
  MatchingParameters own_;
};

}  // namespace

std::unique_ptr<Registration> untouched_pcl_icp_normals(const MatchingParameters& own) {
  return std::make_unique<UntouchedPcl>(icp_normals, own);
}
std::unique_ptr<Registration> untouched_pcl_gicp(const MatchingParameters& own) {
  return std::make_unique<UntouchedPcl>(gicp, own);
}
std::unique_ptr<Registration> untouched_pcl_ndt(const MatchingParameters& own) {
  return std::make_unique<UntouchedPcl>(ndt, own);
}

}  // namespace canyon::lidar
