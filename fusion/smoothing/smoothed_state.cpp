#include "canyon/fusion/smoothing/smoothed_state.h"

#include "canyon/fusion/error_state.h"

namespace canyon::fusion {

NavEstimate estimate_of(const SmoothedState& state, const LocalFrame& frame, const Eigen::Vector3d& lever_U_B) {
  const NavState& nav = state.nav;
  const Eigen::Matrix3d R_WE = frame.R_EW().transpose();
  const Eigen::Matrix3d R_EB = nav.R_EU.toRotationMatrix();  // axes of U are parallel to B
  const Eigen::Vector3d swing_U = state.w_EU_U.cross(lever_U_B);
  NavEstimate out;
  out.t = nav.t;
  out.X_WB.R = (Eigen::Quaterniond(R_WE) * nav.R_EU).normalized();
  out.X_WB.p = frame.to_W(nav.p_EU_E) - out.X_WB.R * lever_U_B;
  out.v_WB_W = R_WE * (nav.v_EU_E - R_EB * swing_U);
  out.gyro_bias_U = state.gyro_bias_U;
  out.accel_bias_U = state.accel_bias_U;

  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>().setIdentity();
  J.bottomLeftCorner<3, 3>() = skew(lever_U_B);
  J.bottomRightCorner<3, 3>() = R_EB.transpose();
  out.pose_covariance = J * state.covariance.topLeftCorner<6, 6>() * J.transpose();
  Eigen::Matrix<double, 3, 9> H = Eigen::Matrix<double, 3, 9>::Zero();
  H.leftCols<3>() = R_WE * R_EB * skew(swing_U);
  H.middleCols<3>(ErrorIndex::kVelocity) = R_WE;
  out.velocity_covariance_W = H * state.covariance * H.transpose();
  return out;
}

}  // namespace canyon::fusion
