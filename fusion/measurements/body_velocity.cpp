#include "canyon/fusion/measurements/body_velocity.h"

#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {

BodyVelocity body_velocity(const FilterView& filter, const Eigen::Vector3d& p_B) {
  const NavState& nav = filter.state.nav;
  const Eigen::Matrix3d R_UE = nav.R_EU.toRotationMatrix().transpose();  // axes of U are parallel to B
  const Eigen::Vector3d v_U = R_UE * nav.v_EU_E, arm = p_B - filter.lever_U_B;
  BodyVelocity out;
  out.v_B = v_U + filter.w_EU_U.cross(arm);
  out.H.setZero(3, filter.state.padded_size());
  out.H.middleCols<3>(ErrorIndex::kTheta) = skew(v_U);
  out.H.middleCols<3>(ErrorIndex::kVelocity) = R_UE;
  // The true rate is the estimated one without what the states feed into the gyroscopes: -e x arm = [arm]x e.
  const Eigen::Matrix3d lever = skew(arm);
  for (const Feed& feed : filter.state.feeds())
    if (feed.axis < 3) out.H.col(feed.state) += feed.rate * lever.col(feed.axis);
  return out;
}

}  // namespace canyon::fusion
