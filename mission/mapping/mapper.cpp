#include "canyon/mission/mapping/mapper.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/motion/adjoint.h"
#include "canyon/core/units.h"

namespace canyon::mission {

namespace {

/// Covariance of a pose error moved from frame B to a frame L rigidly attached to it: xi_L = Ad(X_LB) xi_B.
Matrix6d moved(const Matrix6d& covariance_B, const Pose& X_BL) {
  const Matrix6d to_L = adjoint(X_BL.inverse());
  return to_L * covariance_B * to_L.transpose();
}

/// What two say of one pose together: X Exp(K xi) with xi = log(X^-1 Y), K = P_X (P_X + P_Y)^-1.
lidar::PosePrior together(const lidar::PosePrior& x, const lidar::PosePrior& y) {
  const Matrix6d sum = x.covariance + y.covariance;
  const Matrix6d K = sum.transpose().partialPivLu().solve(x.covariance.transpose()).transpose();
  const Vector6d xi = (x.X_TS.inverse() * y.X_TS).log();
  const Matrix6d left = Matrix6d::Identity() - K;
  const Matrix6d P = left * x.covariance * left.transpose() + K * y.covariance * K.transpose();
  return {x.X_TS * Pose::exp(K * xi), 0.5 * (P + P.transpose())};
}

/// Whether the two lie within the 99.9 % bound of their difference.
bool agree(const lidar::PosePrior& x, const lidar::PosePrior& y) {
  constexpr double kProbability = 1e-3;
  const Vector6d xi = (x.X_TS.inverse() * y.X_TS).log();
  const Matrix6d P = x.covariance + y.covariance;
  return xi.dot(P.ldlt().solve(xi)) < chi_square_threshold(kProbability, 6.0);
}

Matrix6d diagonal(double rotation_rad, double translation_m) {
  Matrix6d P = Matrix6d::Zero();
  P.diagonal() << Eigen::Vector3d::Constant(rotation_rad * rotation_rad),
      Eigen::Vector3d::Constant(translation_m * translation_m);
  return P;
}

/// To which the submap is thinned. PCL's methods, as their users know them, take all points of all clouds.
double submap_leaf_m(const lidar::RegistrationConfig& config) {
  const bool own = lidar::registers(config) && !config.method.name.starts_with("pcl_");
  return own ? config.method.own.get<lidar::MatchingParameters>().leaf_m : 0.0;
}

}  // namespace

Mapper::Mapper(const lidar::RegistrationConfig& config, std::unique_ptr<lidar::Registration> registration,
               const Pose& X_BL, std::shared_ptr<const lidar::PreparedCloud> prior_map)
    : config_(config),
      registration_(std::move(registration)),
      X_BL_(X_BL),
      prior_map_(std::move(prior_map)),
      submap_(submap_leaf_m(config), static_cast<std::size_t>(config.submap_keyframes)) {}

bool Mapper::wants(const NavEstimate& estimate) const {
  if (!chosen_) return true;
  const Pose moved_by = chosen_->inverse() * (estimate.X_WB * X_BL_);
  return !(moved_by.p.norm() < config_.keyframe_distance_m &&
           so3_log(moved_by.R).norm() < config_.keyframe_angle_deg * kDegree);
}

const Keyframe* Mapper::offer(const LidarScan& scan, const NavEstimate& estimate, const RelativePose& motion) {
  if (!wants(estimate)) return nullptr;
  choose(estimate);
  return &place(scan, estimate, motion);
}

const Keyframe& Mapper::place(const LidarScan& scan, const NavEstimate& estimate, const RelativePose& motion) {
  Keyframe keyframe;
  keyframe.t = scan.t;
  keyframe.X_WL_prior = keyframe.X_WL_registered = estimate.X_WB * X_BL_;
  keyframe.points = scan.points.size();
  keyframe.prior_covariance = keyframe.covariance = moved(estimate.pose_covariance, X_BL_);
  if (registers(config_)) {
    std::vector<Eigen::Vector3f> points;
    points.reserve(scan.points.size());
    for (const LidarPoint& point : scan.points) points.emplace_back(point.x, point.y, point.z);
    const auto cloud = registration_->prepare(points);
    // The first one defines the map.
    Pose X_OL;
    if (has_last_) {
      const double elapsed_s = scan.t - last_.t;
      const lidar::PosePrior predicted{
          X_BL_.inverse() * motion.X_TS * X_BL_,
          moved(motion.covariance, X_BL_) +
              diagonal(config_.motion_floor_deg_s * kDegree * elapsed_s, config_.motion_floor_m_s * elapsed_s)};
      const lidar::PosePrior moved_by = align(*cloud, predicted, keyframe);
      X_OL = submap_.last() * moved_by.X_TS;
      fuse(moved_by, keyframe);
      if (keyframe.status != lidar::RegistrationStatus::kConverged) submap_.clear();
    }
    submap_.add(cloud, X_OL);
    if (prior_map_) find_in_map(*cloud, keyframe);
  }
  last_ = keyframe;
  has_last_ = true;
  correction_ = keyframe.X_WL_registered * keyframe.X_WL_prior.inverse();
  return last_;
}

Mapper::Alignment Mapper::aligned(const lidar::PreparedCloud& cloud,
                                  std::span<const lidar::Registration::Placed> targets, const lidar::PosePrior& given,
                                  const Matrix6d& floor) {
  lidar::RegistrationResult result = registration_->align_with_prior(cloud, targets, given);
  counters_.iterations += result.iterations;
  counters_.correspondences += result.correspondences;
  counters_.pcl_objects += result.pcl_objects;
  const auto surfaces = result.surfaces.value_or(lidar::RegistrationResult::Surfaces{result.X_TS, result.covariance});
  // A method that does not say how sure it is counts for as much as what was known before.
  const bool says = surfaces.covariance.allFinite();
  const lidar::PosePrior alone{surfaces.X_TS, (says ? surfaces.covariance : given.covariance) + floor};
  // Whether it contradicts what was known is judged with all that is known of its errors.
  if (result.status == lidar::RegistrationStatus::kBeyondPrior && agree(alone, given))
    result.status = lidar::RegistrationStatus::kConverged;
  return {std::move(result), alone};
}

lidar::PosePrior Mapper::align(const lidar::PreparedCloud& cloud, const lidar::PosePrior& predicted,
                               Keyframe& keyframe) {
  // In the frame of the last keyframe, where numbers stay small.
  const auto targets = submap_.in(submap_.last().inverse());
  const Matrix6d floor = diagonal(config_.alignment_floor_deg * kDegree, config_.alignment_floor_m);
  const auto [result, alone] = aligned(cloud, targets, predicted, floor);
  ++counters_.alignments;
  keyframe.status = result.status;
  keyframe.iterations = result.iterations;
  keyframe.rms_m = result.rms_m;
  keyframe.overlap = result.overlap;
  if (result.status != lidar::RegistrationStatus::kConverged) return predicted;
  if (result.surfaces) keyframe.open = result.open;
  keyframe.alone =
      RelativePose{.source = keyframe.t, .target = last_.t, .X_TS = alone.X_TS, .covariance = alone.covariance};
  const Pose X_LB = X_BL_.inverse();
  keyframe.aligned = RelativePose{.source = keyframe.t,
                                  .target = last_.t,
                                  .X_TS = X_BL_ * alone.X_TS * X_LB,
                                  .covariance = moved(alone.covariance, X_LB)};
  // Those who know the surfaces alone leave it to the mapper, who knows their floor, to weigh them with the prediction.
  return result.surfaces ? together(predicted, alone) : alone;
}

void Mapper::find_in_map(const lidar::PreparedCloud& cloud, Keyframe& keyframe) {
  // In the frame of where the keyframe is taken to be, so that the prior is no turn and no way.
  const Pose X_WL = keyframe.X_WL_registered;
  const lidar::Registration::Placed map{prior_map_, X_WL.inverse()};
  constexpr double kLeast_m = 0.1;
  const double way_m = has_last_ ? (X_WL.inverse() * last_.X_WL_registered).p.norm() : config_.prior_map_correlation_m;
  const double alike = std::max(1.0, config_.prior_map_correlation_m / std::max(way_m, kLeast_m));
  const Matrix6d floor = diagonal(config_.alignment_floor_deg * kDegree, config_.alignment_floor_m) +
                         alike * diagonal(config_.prior_map_sigma_deg * kDegree, config_.prior_map_sigma_m);
  const lidar::PosePrior known{Pose{}, keyframe.covariance};
  const auto [result, alone] = aligned(cloud, {&map, 1}, known, floor);
  keyframe.map_status = result.status;
  if (result.status != lidar::RegistrationStatus::kConverged) return;
  // Methods that make no use of the prior do not look whether they contradict it.
  if (!agree(alone, known)) {
    keyframe.map_status = lidar::RegistrationStatus::kBeyondPrior;
    return;
  }
  ++counters_.found_in_map;
  const Pose X_LB = X_BL_.inverse();
  keyframe.in_map =
      PoseInMap{.t = keyframe.t, .X_WB = X_WL * alone.X_TS * X_LB, .covariance = moved(alone.covariance, X_LB)};
  const lidar::PosePrior fused = result.surfaces ? together(known, alone) : alone;
  keyframe.X_WL_registered = X_WL * fused.X_TS;
  keyframe.covariance = fused.covariance;
}

void Mapper::fuse(const lidar::PosePrior& moved_by, Keyframe& keyframe) const {
  keyframe.placed =
      RelativePose{.source = keyframe.t, .target = last_.t, .X_TS = moved_by.X_TS, .covariance = moved_by.covariance};
  const double elapsed_s = std::max(keyframe.t - last_.t, 1e-3);
  const lidar::PosePrior carried{last_.X_WL_registered * moved_by.X_TS,
                                 moved(last_.covariance, moved_by.X_TS) + moved_by.covariance};
  const lidar::PosePrior absolute{keyframe.X_WL_prior,
                                  keyframe.prior_covariance * std::max(1.0, config_.prior_correlation_s / elapsed_s)};
  const lidar::PosePrior fused = together(carried, absolute);
  keyframe.X_WL_registered = fused.X_TS;
  keyframe.covariance = fused.covariance;
}

}  // namespace canyon::mission
