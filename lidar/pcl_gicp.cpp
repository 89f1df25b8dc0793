// The only file that includes PCL: its registration headers cost much build time and memory.
#include <cmath>
#include <limits>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

#include "lidar/neighbour_grid.h"
#include "lidar/prepared_cloud.h"
#include "lidar/registration_covariance.h"
#include "lidar/registration_methods.h"

namespace canyon::lidar {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using PclGicp = pcl::GeneralizedIterativeClosestPoint<Point, Point, double>;
using Matrices = PclGicp::MatricesVector;

constexpr double kPlaneThickness =
    1e-3;  // epsilon of Segal et al. 2009: variance across a plane over variance along it
constexpr double kTranslationEpsilon_m = 2e-4;
constexpr double kRotationEpsilon_rad = 2e-5;
constexpr std::size_t kFewestPoints = 50;  // in the source, the target, and matched

/// PCL's interface over our own grid: exact within the radius, and several times faster than FLANN's tree, which would
/// be rebuilt for every new union of target clouds.
class GridSearch final : public pcl::search::KdTree<Point> {
 public:
  GridSearch(std::span<const Eigen::Vector3f> points, double cell_m, double radius_m)
      : grid_(points, cell_m), radius_m_(radius_m) {}

  int nearestKSearch(const Point& query, int k, pcl::Indices& indices, std::vector<float>& squared_m) const override {
    indices.resize(1);
    squared_m.resize(1);
    grid_.nearest(query.getVector3fMap(), static_cast<std::size_t>(k), radius_m_, found_);
    // PCL takes "none found" for a broken tree and gives up; a neighbour beyond its threshold is what it can digest.
    indices[0] = found_.empty() ? 0 : static_cast<int>(found_[0].index);
    squared_m[0] = found_.empty() ? std::numeric_limits<float>::max() : found_[0].squared_m;
    return 1;
  }

 private:
  NeighbourGrid grid_;
  double radius_m_;
  mutable std::vector<NeighbourGrid::Neighbour> found_;
};

/// PCL 1.13's generalized ICP with what it lacks: a Newton step in place of BFGS for the inner problem (PCL 1.14 made
/// the same change; BFGS takes some hundred passes over the matches), the matches for a covariance, and an honest
/// convergence flag (PCL reports "converged" also when it ran out of iterations).
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
  std::size_t matched() const { return source_indices_.size(); }
  int rounds() const { return nr_iterations_; }

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
    settled_ = false;
    if (source_indices.size() < kFewestPoints) {
      PCL_THROW_EXCEPTION(pcl::NotEnoughPointsException, "too few matches");  // caught by computeTransformation
    }
    const Eigen::Matrix3d R = transform.topLeftCorner<3, 3>();
    const Eigen::Vector3d p = transform.topRightCorner<3, 1>();
    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
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
    }
    H.bottomLeftCorner<3, 3>() = H.topRightCorner<3, 3>().transpose();
    const Vector6d xi = -H.ldlt().solve(g);
    if (!xi.allFinite()) PCL_THROW_EXCEPTION(pcl::SolverDidntConvergeException, "singular geometry");
    const Matrix4 moved = (Pose::from_matrix(transform) * Pose::exp(xi)).matrix();
    // PCL stops by the same rule, element by element, but does not say so if it stops for the iterations' sake.
    const Eigen::Array44d change = (moved - transform).array().abs();
    settled_ = (change.topLeftCorner<3, 3>() < kRotationEpsilon_rad).all() &&
               (change.topRightCorner<3, 1>() < kTranslationEpsilon_m).all();
    transform = moved;
  }

  pcl::Indices source_indices_, target_indices_;
  bool settled_ = false;
};

Eigen::Matrix3d plane_covariance(const Eigen::Vector3d& normal) {
  return Eigen::Matrix3d::Identity() - (1.0 - kPlaneThickness) * normal * normal.transpose();
}

class GicpRegistration final : public Registration {
 public:
  explicit GicpRegistration(const RegistrationConfig& config) : config_(config) {}

  std::shared_ptr<const PreparedCloud> prepare(std::span<const Eigen::Vector3f> points) const override {
    return std::make_shared<PreparedCloud>(prepare_cloud(points, config_.leaf_m));
  }

  /// Works in the frame G of the guess: there PCL's own guess is the identity, so that single precision is spent on the
  /// small correction and not on map coordinates.
  RegistrationResult align(const PreparedCloud& source, std::span<const Placed> targets,
                           const Pose& guess) const override {
    RegistrationResult result;
    result.status = RegistrationStatus::kTooFewPoints;
    result.X_TS = guess;

    const auto target_cloud = pcl::make_shared<Cloud>();
    const auto target_covariances = pcl::make_shared<Matrices>();
    std::vector<Eigen::Vector3f> target_points;
    std::vector<float> target_tilt;
    for (const Placed& placed : targets) {
      const Pose X_GC = guess.inverse() * placed.X_TC;
      const Eigen::Matrix3d R_GC = X_GC.R.toRotationMatrix();
      for (std::size_t i = 0; i < placed.cloud->points.size(); ++i) {
        const Eigen::Vector3f p = (R_GC * placed.cloud->points[i].cast<double>() + X_GC.p).cast<float>();
        target_points.push_back(p);
        target_cloud->push_back(Point(p.x(), p.y(), p.z()));
        target_covariances->push_back(plane_covariance(R_GC * placed.cloud->normals[i].cast<double>()));
        target_tilt.push_back(placed.cloud->tilt_variance[i]);
      }
    }
    if (source.points.size() < kFewestPoints || target_points.size() < kFewestPoints) return result;

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
    gicp.setSearchMethodTarget(
        pcl::make_shared<GridSearch>(target_points, config_.leaf_m, config_.max_correspondence_m), true);
    gicp.setSearchMethodSource(pcl::make_shared<pcl::search::KdTree<Point>>(), true);
    gicp.setInputSource(source_cloud);
    gicp.setInputTarget(target_cloud);
    gicp.setSourceCovariances(source_covariances);  // after the clouds, which reset them
    gicp.setTargetCovariances(target_covariances);
    Cloud aligned;
    gicp.align(aligned);

    result.iterations = gicp.rounds();
    if (gicp.matched() < kFewestPoints) return result;
    const Eigen::Matrix4d X_GS = gicp.getFinalTransformation();
    result.X_TS = guess * Pose::from_matrix(X_GS);
    result.status = gicp.settled() ? RegistrationStatus::kConverged : RegistrationStatus::kNotConverged;
    const auto matches = gicp.correspondences(source, target_tilt, X_GS);
    const RegistrationPrecision precision = registration_precision(matches, X_GS.topLeftCorner<3, 3>());
    result.covariance = precision.covariance;
    result.rms_m = precision.rms_m;
    return result;
  }

 private:
  RegistrationConfig config_;
};

}  // namespace

std::unique_ptr<Registration> make_gicp(const RegistrationConfig& config) {
  return std::make_unique<GicpRegistration>(config);
}

}  // namespace canyon::lidar
