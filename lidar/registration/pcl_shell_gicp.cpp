// PCL's registration headers cost much build time and memory: this file and pcl_untouched.cpp have them, no other.
#include <cmath>
#include <limits>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

#include "canyon/lidar/registration/neighbour_tree.h"
#include "canyon/lidar/registration/pcl_part.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/registration_covariance.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using PclGicp = pcl::GeneralizedIterativeClosestPoint<Point, Point, double>;
using Matrices = PclGicp::MatricesVector;

// epsilon of Segal et al. 2009: variance across a plane over variance along it.
constexpr double kPlaneThickness = 1e-3;
constexpr double kTranslationEpsilon_m = 2e-4;
constexpr double kRotationEpsilon_rad = 2e-5;
// Normals come from neighbours up to some eight leaves away, so residuals correlate over twice that.
constexpr double kBlock_leaves = 16.0;
constexpr std::size_t kFewestPoints = 50;  // in the source, the target, and matched
constexpr double kFarthest_m = 1e8;        // farther than two clouds of 2^20 voxels can be apart

/// PCL's interface over our own tree, which is bounded by the correspondence distance and builds and answers faster.
/// Where nothing lies within it the distance is infinite: PCL takes "none found" for a broken tree and gives up.
class TreeSearch final : public pcl::search::KdTree<Point> {
 public:
  TreeSearch(std::span<const Eigen::Vector3f> points, double radius_m)
      : tree_(points), radius_m_(static_cast<float>(radius_m)) {}

  int nearestKSearch(const Point& query, int, pcl::Indices& indices, std::vector<float>& squared_m) const override {
    NeighbourTree::Neighbour nearest{std::numeric_limits<float>::infinity(), 0};
    tree_.nearest(query.getVector3fMap(), radius_m_, {&nearest, 1});
    indices.assign(1, static_cast<int>(nearest.index));
    squared_m.assign(1, nearest.squared_m);
    return 1;
  }

 private:
  NeighbourTree tree_;
  float radius_m_;
};

/// PCL 1.13's generalized ICP with what it lacks: a Newton step in place of BFGS for the inner problem (PCL 1.14
/// made the same change; BFGS takes some hundred passes over the matches), the matches for a covariance, and an
/// honest convergence flag (PCL reports "converged" also when it ran out of iterations).
class Gicp final : public PclGicp {
 public:
  Gicp() {
    rigid_transformation_estimation_ = [this](const Cloud& source, const pcl::Indices& source_indices,
                                              const Cloud& target, const pcl::Indices& target_indices,
                                              Matrix4& transform) {
      step(source, source_indices, target, target_indices, transform);
    };
  }

  bool settled() const { return settled_; }
  bool degenerate() const { return degenerate_; }
  std::size_t matched() const { return source_indices_.size(); }
  int rounds() const { return nr_iterations_; }
  std::int64_t all_matched() const { return all_matched_; }  ///< summed over the rounds

  std::vector<Correspondence> correspondences(const PreparedCloud& source, const std::vector<float>& target_tilt,
                                              const Matrix4& X) const {
    std::vector<Correspondence> matches(source_indices_.size());
    for (std::size_t k = 0; k < matches.size(); ++k) {
      const auto i = static_cast<std::size_t>(source_indices_[k]);
      const auto j = static_cast<std::size_t>(target_indices_[k]);
      Correspondence& match = matches[k];
      match.p_S = source.points[i].cast<double>();
      match.residual = X.topLeftCorner<3, 3>() * match.p_S + X.topRightCorner<3, 1>() -
                       (*target_)[j].getVector3fMap().cast<double>();
      match.information = mahalanobis_[i];
      // The common normal is the mean of the two.
      match.tilt_variance = 0.25 * (source.tilt_variance[i] + target_tilt[j]);
    }
    return matches;
  }

 private:
  /// One Gauss-Newton step of sum d^T M d, d = T p_s - p_t, over a perturbation T Exp(xi). More steps on the same
  /// matches would be wasted: the matches change as soon as the cloud moves.
  void step(const Cloud& source, const pcl::Indices& source_indices, const Cloud& target,
            const pcl::Indices& target_indices, Matrix4& transform) {
    source_indices_ = source_indices;
    target_indices_ = target_indices;
    all_matched_ += static_cast<std::int64_t>(source_indices.size());
    settled_ = false;
    if (source_indices.size() < kFewestPoints) {
      PCL_THROW_EXCEPTION(pcl::NotEnoughPointsException, "too few matches");  // caught by computeTransformation
    }
    const Eigen::Matrix3d R = transform.topLeftCorner<3, 3>();
    const Eigen::Vector3d p = transform.topRightCorner<3, 1>();
    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    double radius2 = 0.0;
    for (std::size_t k = 0; k < source_indices.size(); ++k) {
      const auto i = static_cast<std::size_t>(source_indices[k]);
      const Eigen::Vector3d p_S = source[i].getVector3fMap().cast<double>();
      const Eigen::Vector3d d =
          R * p_S + p - target[static_cast<std::size_t>(target_indices[k])].getVector3fMap().cast<double>();
      // In the source frame J is simply [-[p]x, I].
      const Eigen::Matrix3d M_S = R.transpose() * mahalanobis_[i] * R;
      const Eigen::Vector3d Md = M_S * (R.transpose() * d);
      const Eigen::Matrix3d pxM = skew(p_S) * M_S;
      H.topLeftCorner<3, 3>() -= pxM * skew(p_S);
      H.topRightCorner<3, 3>() += pxM;
      H.bottomRightCorner<3, 3>() += M_S;
      g.head<3>() += p_S.cross(Md);
      g.tail<3>() += Md;
      radius2 += p_S.squaredNorm();
    }
    H.bottomLeftCorner<3, 3>() = H.topRightCorner<3, 3>().transpose();
    degenerate_ = !determines_pose(H, std::sqrt(radius2 / static_cast<double>(source_indices.size())));
    if (degenerate_) PCL_THROW_EXCEPTION(pcl::SolverDidntConvergeException, "singular geometry");
    const Vector6d xi = -H.ldlt().solve(g);
    const Matrix4 moved = (Pose::from_matrix(transform) * Pose::exp(xi)).matrix();
    // A step that leaves all maps behind would meet no target; PCL goes on in single precision.
    if (!(moved.array().abs() < kFarthest_m).all())
      PCL_THROW_EXCEPTION(pcl::SolverDidntConvergeException, "the step is not finite");
    // PCL stops by the same rule, element by element, but does not say so if it stops for the iterations' sake.
    const Eigen::Array44d change = (moved - transform).array().abs();
    settled_ = (change.topLeftCorner<3, 3>() < kRotationEpsilon_rad).all() &&
               (change.topRightCorner<3, 1>() < kTranslationEpsilon_m).all();
    transform = moved;
  }

  pcl::Indices source_indices_, target_indices_;
  bool settled_ = false, degenerate_ = false;
  std::int64_t all_matched_ = 0;
};

Eigen::Matrix3d plane_covariance(const Eigen::Vector3d& normal) {
  return Eigen::Matrix3d::Identity() - (1.0 - kPlaneThickness) * normal * normal.transpose();
}

class GicpRegistration final : public Registration {
 public:
  explicit GicpRegistration(const MatchingParameters& config) : config_(config) {}

  std::shared_ptr<const PreparedCloud> prepare(std::span<const Eigen::Vector3f> points) const override {
    return std::make_shared<PreparedCloud>(prepare_cloud(points, config_.leaf_m));
  }

  /// Works in the frame G of the guess: there PCL's own guess is the identity, so that single precision is spent on
  /// the small correction and not on map coordinates.
  RegistrationResult align(const PreparedCloud& source, std::span<const Placed> targets,
                           const Pose& guess) const override {
    RegistrationResult result;
    result.X_TS = guess;
    result.status = RegistrationStatus::kDiverged;
    if (!guess.matrix().allFinite()) return result;
    result.status = RegistrationStatus::kTooFewPoints;

    const Target target = unite(targets, guess);
    result.pcl_objects = 1;  // the target's cloud
    if (source.points.size() < kFewestPoints || target.points.size() < kFewestPoints) return result;

    const auto source_cloud = pcl::make_shared<Cloud>();
    const auto source_covariances = pcl::make_shared<Matrices>();
    source_cloud->reserve(source.points.size());
    source_covariances->reserve(source.points.size());
    for (std::size_t i = 0; i < source.points.size(); ++i) {
      source_cloud->push_back(Point(source.points[i].x(), source.points[i].y(), source.points[i].z()));
      source_covariances->push_back(plane_covariance(source.normals[i].cast<double>()));
    }

    Gicp gicp;
    gicp.setMaxCorrespondenceDistance(config_.max_correspondence_m);
    gicp.setMaximumIterations(static_cast<int>(config_.max_iterations));
    gicp.setTransformationEpsilon(kTranslationEpsilon_m);
    gicp.setRotationEpsilon(kRotationEpsilon_rad);
    // "true": PCL must not rebuild either tree; the source's is never asked.
    gicp.setSearchMethodTarget(pcl::make_shared<TreeSearch>(target.points, config_.max_correspondence_m), true);
    gicp.setSearchMethodSource(pcl::make_shared<pcl::search::KdTree<Point>>(), true);
    gicp.setInputSource(source_cloud);
    gicp.setInputTarget(target.cloud);
    gicp.setSourceCovariances(source_covariances);  // after the clouds, which reset them
    gicp.setTargetCovariances(target.covariances);
    Cloud aligned;
    gicp.align(aligned);

    result.iterations = gicp.rounds();
    result.correspondences = gicp.all_matched();
    result.pcl_objects = 6;  // three clouds, two search trees, the registration
    if (gicp.matched() < kFewestPoints) return result;
    result.status = RegistrationStatus::kDegenerate;
    if (gicp.degenerate()) return result;
    const Eigen::Matrix4d X_GS = gicp.getFinalTransformation();
    result.X_TS = guess * Pose::from_matrix(X_GS);
    result.status = gicp.settled() ? RegistrationStatus::kConverged : RegistrationStatus::kNotConverged;
    const auto matches = gicp.correspondences(source, target.tilt_variance, X_GS);
    const RegistrationPrecision precision =
        registration_precision(matches, X_GS.topLeftCorner<3, 3>(), kBlock_leaves * config_.leaf_m);
    if (!precision.covariance.allFinite()) {
      result.X_TS = guess;
      result.status = RegistrationStatus::kDegenerate;
      return result;
    }
    result.covariance = precision.covariance;
    result.rms_m = precision.rms_m;
    return result;
  }

 private:
  struct Target {
    std::vector<Eigen::Vector3f> points;
    std::vector<float> tilt_variance;
    Cloud::Ptr cloud = pcl::make_shared<Cloud>();
    PclGicp::MatricesVectorPtr covariances;
  };

  /// The union of the placed clouds in the frame of the guess. Where clouds overlap, a voxel belongs to the cloud
  /// given last, normally the newest and thus best placed: the whole of ten overlapping keyframes costs twice as
  /// much and registers no better.
  Target unite(std::span<const Placed> targets, const Pose& guess) const {
    Target target;
    target.covariances = pcl::make_shared<Matrices>();
    VoxelIndex voxels(config_.leaf_m, 10000);
    for (std::size_t k = targets.size(); k-- > 0;) {
      const PreparedCloud& cloud = *targets[k].cloud;
      const Pose X_GC = guess.inverse() * targets[k].X_TC;
      const Eigen::Matrix3d R_GC = X_GC.R.toRotationMatrix();
      const std::uint32_t occupied = voxels.size();
      for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const Eigen::Vector3f p = (R_GC * cloud.points[i].cast<double>() + X_GC.p).cast<float>();
        const auto voxel = voxels.coordinates(p);  // none: far from the guess, so nothing to match
        if (!voxel || voxels.insert(*voxel) < occupied) continue;
        target.points.push_back(p);
        target.tilt_variance.push_back(cloud.tilt_variance[i]);
        target.cloud->push_back(Point(p.x(), p.y(), p.z()));
        target.covariances->push_back(plane_covariance(R_GC * cloud.normals[i].cast<double>()));
      }
    }
    return target;
  }

  MatchingParameters config_;
};

std::unique_ptr<Registration> make(const MatchingParameters& config) {
  return std::make_unique<GicpRegistration>(config);
}

}  // namespace

extern "C" const PclPart canyon_pcl_part{make, untouched_pcl_icp_normals, untouched_pcl_gicp, untouched_pcl_ndt};

}  // namespace canyon::lidar
