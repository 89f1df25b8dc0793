#include "canyon/study/registration_error/events/estimate_jumps.h"

#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"

namespace canyon::study {
namespace {

/// Covariance of xi of B from that of xi of the frame that it was before: xi' = Ad(X^-1) xi.
Matrix6d carried(const Matrix6d& covariance, const Pose& X) {
  const Pose inverse = X.inverse();
  const Eigen::Matrix3d R = inverse.R.toRotationMatrix();
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = R;
  adjoint.bottomLeftCorner<3, 3>() = skew(inverse.p) * R;
  return adjoint * covariance * adjoint.transpose();
}

bool is_jump(const Eigen::Vector3d& correction_B_m, const Eigen::Matrix3d& covariance_B) {
  if (correction_B_m.norm() > EstimateJumps::kJump_m) return true;
  constexpr double kBeyond3Sigma = 0.0027;
  static const double bound = chi_square_threshold(kBeyond3Sigma, 3);
  const Eigen::LLT<Eigen::Matrix3d> factor(covariance_B);
  return factor.info() == Eigen::Success && factor.matrixL().solve(correction_B_m).squaredNorm() > bound;
}

}  // namespace

void EstimateJumps::add(double t_s, const NavEstimate& estimate, const RelativePose& motion) {
  if (last_) {
    const bool from_start = motion.target == last_->motion.target;
    const Pose moved_by = from_start ? last_->motion.X_TS.inverse() * motion.X_TS : motion.X_TS;
    const Pose predicted = last_->estimate.X_WB * moved_by;
    const Eigen::Vector3d correction_B_m = predicted.R.conjugate() * (estimate.X_WB.p - predicted.p);
    Matrix6d covariance = carried(last_->estimate.pose_covariance, moved_by);
    if (!from_start && motion.covariance.allFinite()) covariance += motion.covariance;
    if (is_jump(correction_B_m, covariance.bottomRightCorner<3, 3>()))
      events_.push_back({MapEventKind::kEstimateJump, t_s, last_->t_s, t_s, correction_B_m.norm()});
  }
  last_ = Keyframe{t_s, estimate, motion};
}

}  // namespace canyon::study
