#include "canyon/fusion/antenna_position.h"

#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {

AntennaPosition antenna_position(const NavState& state, const Eigen::Vector3d& w_EU_U, const Eigen::Vector3d& arm_U,
                                 double age_s) {
  const Eigen::Matrix3d R_EU = state.R_EU.toRotationMatrix();
  const Eigen::Vector3d arm_then_U = arm_U + age_s * w_EU_U.cross(arm_U);
  AntennaPosition out;
  out.p_A_E = state.p_EU_E + R_EU * arm_then_U + age_s * state.v_EU_E;
  out.H.leftCols<3>() = -R_EU * skew(arm_then_U);
  out.H.middleCols<3>(ErrorIndex::kPosition).setIdentity();
  out.H.middleCols<3>(ErrorIndex::kVelocity) = age_s * Eigen::Matrix3d::Identity();
  return out;
}

}  // namespace canyon::fusion
