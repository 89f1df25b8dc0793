#include "canyon/fusion/measurements/body_velocity.h"

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/gravity.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

/// d w_EU_U: the true rate is the estimated one without what the states feed into the gyroscopes, and the Earth's part
/// of it turns with the attitude.
BodyRows rate_rows(const FilterView& filter) {
  const NavState& nav = filter.state.nav;
  BodyRows H = BodyRows::Zero(3, filter.state.padded_size());
  H.middleCols<3>(ErrorIndex::kTheta) = -skew(nav.R_EU.conjugate() * earth_rate_E());
  for (const Feed& feed : filter.state.feeds())
    if (feed.axis < 3) H.col(feed.state) -= feed.rate * filter.imu.gyro_inverse.col(feed.axis);
  return H;
}

}  // namespace

BodyVelocity body_velocity(const FilterView& filter, const Eigen::Vector3d& p_B) {
  const NavState& nav = filter.state.nav;
  const Eigen::Matrix3d R_UE = nav.R_EU.toRotationMatrix().transpose();  // axes of U are parallel to B
  const Eigen::Vector3d v_U = R_UE * nav.v_EU_E, arm = p_B - filter.lever_U_B;
  BodyVelocity out{.v_B = v_U + filter.w_EU_U.cross(arm), .H = -skew(arm) * rate_rows(filter)};
  out.H.middleCols<3>(ErrorIndex::kTheta) += skew(v_U);
  out.H.middleCols<3>(ErrorIndex::kVelocity) += R_UE;
  return out;
}

PointVelocity point_velocity(const FilterView& filter, const Eigen::Vector3d& p_B) {
  const Eigen::Matrix3d R_EU = filter.state.nav.R_EU.toRotationMatrix();
  const BodyVelocity point = body_velocity(filter, p_B);
  PointVelocity out{.v_E = R_EU * point.v_B, .H = R_EU * point.H};
  out.H.middleCols<3>(ErrorIndex::kTheta) -= R_EU * skew(point.v_B);
  return out;
}

BodyAcceleration body_acceleration(const FilterView& filter) {
  const NavState& nav = filter.state.nav;
  const Eigen::Matrix3d R_UE = nav.R_EU.toRotationMatrix().transpose();
  const Eigen::Vector3d v_U = R_UE * nav.v_EU_E, gravity_U = R_UE * gravity_E(nav.p_EU_E);
  const Eigen::Vector3d& w = filter.w_EU_U;
  const Eigen::Vector3d earth_U = R_UE * earth_rate_E();
  BodyAcceleration out;
  out.a_B = filter.f_U + gravity_U - 2.0 * earth_U.cross(v_U) - w.cross(v_U);
  const BodyRows dw = rate_rows(filter);
  out.H = skew(v_U) * dw;
  out.H.middleCols<3>(ErrorIndex::kTheta) +=
      skew(gravity_U) - 2.0 * (skew(earth_U) * skew(v_U) - skew(v_U) * skew(earth_U)) - skew(w) * skew(v_U);
  out.H.middleCols<3>(ErrorIndex::kVelocity) += -2.0 * skew(earth_U) * R_UE - skew(w) * R_UE;
  out.H.middleCols<3>(ErrorIndex::kPosition) += R_UE * gravity_gradient_E(nav.p_EU_E);
  for (const Feed& feed : filter.state.feeds())
    if (feed.axis >= 3) out.H.col(feed.state) -= feed.rate * filter.imu.accel_inverse.col(feed.axis - 3);
  return out;
}

}  // namespace canyon::fusion
