#include "canyon/mission/mapper.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "canyon/core/units.h"

namespace canyon::mission {

namespace {

/// Covariance of a pose error moved from frame B to a frame L rigidly attached to it: xi_L = Ad(X_LB) xi_B.
Matrix6d moved(const Matrix6d& covariance_B, const Pose& X_BL) {
  const Pose X_LB = X_BL.inverse();
  const Eigen::Matrix3d R = X_LB.R.toRotationMatrix();
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = R;
  adjoint.bottomRightCorner<3, 3>() = R;
  adjoint.bottomLeftCorner<3, 3>() = skew(X_LB.p) * R;
  return adjoint * covariance_B * adjoint.transpose();
}

}  // namespace

Mapper::Mapper(const lidar::RegistrationConfig& config, std::unique_ptr<lidar::Registration> registration,
               const Pose& X_BL)
    : config_(config), registration_(std::move(registration)), X_BL_(X_BL) {}

bool Mapper::wants(const NavEstimate& estimate) const {
  if (!has_last_) return true;
  const Pose moved_by = last_.X_WL_prior.inverse() * (estimate.X_WB * X_BL_);
  return !(moved_by.p.norm() < config_.keyframe_distance_m &&
           so3_log(moved_by.R).norm() < config_.keyframe_angle_deg * kDegree);
}

const Keyframe* Mapper::offer(const LidarScan& scan, const NavEstimate& estimate, const Pose& motion) {
  if (!wants(estimate)) return nullptr;
  Keyframe keyframe;
  keyframe.t = scan.t;
  keyframe.X_WL_prior = keyframe.X_WL_registered = estimate.X_WB * X_BL_;
  keyframe.points = scan.points.size();
  Matrix6d covariance = moved(estimate.pose_covariance, X_BL_);
  if (registers(config_)) {
    std::vector<Eigen::Vector3f> points;
    points.reserve(scan.points.size());
    for (const LidarPoint& point : scan.points) points.emplace_back(point.x, point.y, point.z);
    const auto cloud = registration_->prepare(points);
    // The first one defines the map.
    if (has_last_) covariance = align(*cloud, X_BL_.inverse() * motion * X_BL_, covariance, keyframe);
    submap_.push_back({cloud, keyframe.X_WL_registered});
    while (submap_.size() > static_cast<std::size_t>(config_.submap_keyframes)) submap_.pop_front();
  }
  last_ = keyframe;
  last_covariance_ = 0.5 * (covariance + covariance.transpose());
  has_last_ = true;
  correction_ = keyframe.X_WL_registered * keyframe.X_WL_prior.inverse();
  return &last_;
}

Matrix6d Mapper::align(const lidar::PreparedCloud& cloud, const Pose& guess, const Matrix6d& prior_covariance,
                       Keyframe& keyframe) {
  // In the frame of the last keyframe, where numbers stay small.
  const Pose X_LW = last_.X_WL_registered.inverse();
  std::vector<lidar::Registration::Placed> targets;
  for (const Placed& placed : submap_) targets.push_back({placed.cloud, X_LW * placed.X_WL});
  const lidar::RegistrationResult result = registration_->align(cloud, targets, guess);
  keyframe.status = result.status;
  keyframe.iterations = result.iterations;
  keyframe.rms_m = result.rms_m;
  ++counters_.alignments;
  counters_.iterations += result.iterations;
  counters_.correspondences += result.correspondences;
  counters_.pcl_objects += result.pcl_objects;
  if (result.status != lidar::RegistrationStatus::kConverged) return prior_covariance;
  const Pose registered = last_.X_WL_registered * result.X_TS;
  const double floor_rad = config_.alignment_floor_deg * kDegree, floor_m = config_.alignment_floor_m;
  Matrix6d floor = Matrix6d::Zero();
  floor.diagonal() << Eigen::Vector3d::Constant(floor_rad * floor_rad), Eigen::Vector3d::Constant(floor_m * floor_m);
  const Pose X_LB = X_BL_.inverse();
  keyframe.aligned = RelativePose{.source = keyframe.t,
                                  .target = last_.t,
                                  .X_TS = X_BL_ * result.X_TS * X_LB,
                                  .covariance = moved(result.covariance + floor, X_LB)};
  const Matrix6d P_Z = moved(last_covariance_, result.X_TS) + result.covariance + floor;
  const double elapsed_s = std::max(keyframe.t - last_.t, 1e-3);
  const Matrix6d P_Y = prior_covariance * std::max(1.0, config_.prior_correlation_s / elapsed_s);
  const Matrix6d K = (P_Z + P_Y).transpose().partialPivLu().solve(P_Z.transpose()).transpose();
  const Vector6d xi = (registered.inverse() * keyframe.X_WL_prior).log();
  keyframe.X_WL_registered = registered * Pose::exp(K * xi);
  const Matrix6d left = Matrix6d::Identity() - K;
  Matrix6d covariance;  // assigned, not returned as an expression, which Eigen would sum in another order
  covariance = left * P_Z * left.transpose() + K * P_Y * K.transpose();
  return covariance;
}

}  // namespace canyon::mission
