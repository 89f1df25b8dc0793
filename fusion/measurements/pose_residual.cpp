#include "canyon/fusion/measurements/pose_residual.h"

#include "canyon/core/check.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

/// Of a unit at R_EU, p_E, whose errors begin at state `at` (attitude, then position in E).
BodyPose pose_of(const FilterView& filter, const Eigen::Quaterniond& R_EU, const Eigen::Vector3d& p_EU_E, int at) {
  const ErrorState& state = filter.state;
  const Eigen::Matrix3d R_BU = state.R_UB().transpose(), R_EB = R_EU.toRotationMatrix() * state.R_UB();
  BodyPose out{.X_EB = {Eigen::Quaterniond(R_EB).normalized(), p_EU_E - R_EB * filter.lever_U_B},
               .H = PoseRows::Zero(6, state.padded_size())};
  out.H.block<3, 3>(0, at) = R_BU;
  if (state.mounting() >= 0) out.H.block<3, 3>(0, state.mounting()) = state.mounting_jacobian();
  // dp_B = dp_U + R_EB [l]x theta_B.
  out.H.bottomRows<3>() = skew(filter.lever_U_B) * out.H.topRows<3>();
  out.H.block<3, 3>(3, at + 3) += R_EB.transpose();
  return out;
}

}  // namespace

BodyPose body_pose(const FilterView& filter) {
  return pose_of(filter, filter.state.nav.R_EU, filter.state.nav.p_EU_E, ErrorIndex::kTheta);
}

BodyPose cloned_body_pose(const FilterView& filter) {
  const auto& clone = filter.state.clone();
  CANYON_CHECK(clone.has_value(), "the clone has not been taken");
  return pose_of(filter, clone->R_EU, clone->p_EU_E, filter.state.offset("clone"));
}

Measurement pose_residual(const ErrorState& state, const Pose& predicted, const PoseRows& H, const Pose& measured,
                          const Matrix6d& covariance) {
  Measurement m(6, state, ErrorIndex::kPosition);
  const Eigen::Vector3d turned = so3_log(predicted.R.conjugate() * measured.R),
                        moved = predicted.R.conjugate() * (measured.p - predicted.p);
  m.residual << turned, moved;
  m.H.topRows<3>() = so3_right_jacobian(-turned).inverse() * H.topRows<3>();
  m.H.bottomRows<3>() = H.bottomRows<3>() - skew(moved) * H.topRows<3>();
  m.R = 0.5 * (covariance + covariance.transpose());
  return m;
}

}  // namespace canyon::fusion
