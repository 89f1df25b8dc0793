#include "canyon/fusion/measurements/body_motion.h"

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

/// The velocity in the axes of U.
BodyVelocity velocity_in_U(const FilterView& filter, const Eigen::Vector3d& p_B) {
  const NavState& nav = filter.state.nav;
  const Eigen::Matrix3d R_UE = nav.R_EU.toRotationMatrix().transpose();
  const Eigen::Vector3d v_U = R_UE * nav.v_EU_E, arm_B = p_B - filter.lever_U_B, arm = filter.state.R_UB() * arm_B;
  BodyVelocity out{.v_B = v_U + filter.w_EU_U.cross(arm), .H = -skew(arm) * rate_rows(filter)};
  out.H.middleCols<3>(ErrorIndex::kTheta) += skew(v_U);
  out.H.middleCols<3>(ErrorIndex::kVelocity) += R_UE;
  if (const int mounting = filter.state.mounting(); mounting >= 0)
    out.H.middleCols<3>(mounting) -=
        skew(filter.w_EU_U) * filter.state.R_UB() * skew(arm_B) * filter.state.mounting_jacobian();
  return out;
}

/// What stands in the axes of U, in those of B.
void turn_to_B(const ErrorState& state, Eigen::Vector3d& vector, BodyRows& H) {
  const int mounting = state.mounting();
  if (mounting < 0) return;
  vector = state.R_UB().transpose() * vector;
  H = state.R_UB().transpose() * H;
  H.middleCols<3>(mounting) += skew(vector) * state.mounting_jacobian();
}

}  // namespace

BodyVelocity body_velocity(const FilterView& filter, const Eigen::Vector3d& p_B) {
  BodyVelocity out = velocity_in_U(filter, p_B);
  turn_to_B(filter.state, out.v_B, out.H);
  return out;
}

PointVelocity point_velocity(const FilterView& filter, const Eigen::Vector3d& p_B) {
  const Eigen::Matrix3d R_EU = filter.state.nav.R_EU.toRotationMatrix();
  const BodyVelocity point = velocity_in_U(filter, p_B);
  PointVelocity out{.v_E = R_EU * point.v_B, .H = R_EU * point.H};
  out.H.middleCols<3>(ErrorIndex::kTheta) -= R_EU * skew(point.v_B);
  return out;
}

PointPlace point_place(const FilterView& filter, const Eigen::Vector3d& p_B) {
  const ErrorState& state = filter.state;
  const Eigen::Matrix3d R_EU = state.nav.R_EU.toRotationMatrix();
  const Eigen::Vector3d arm_B = p_B - filter.lever_U_B, arm_U = state.R_UB() * arm_B;
  PointPlace out{.p_E = state.nav.p_EU_E + R_EU * arm_U, .H = BodyRows::Zero(3, state.padded_size())};
  out.H.middleCols<3>(ErrorIndex::kTheta) = -R_EU * skew(arm_U);
  out.H.middleCols<3>(ErrorIndex::kPosition).setIdentity();
  if (state.mounting() >= 0)
    out.H.middleCols<3>(state.mounting()) = -R_EU * state.R_UB() * skew(arm_B) * state.mounting_jacobian();
  return out;
}

namespace {

Eigen::Vector3d antenna_B(const FilterView& filter, int lever) {
  return lever < 0 ? filter.lever_A_B : filter.lever_A_B + filter.state.values(lever, 3);
}

}  // namespace

PointPlace antenna_place(const FilterView& filter) {
  const int lever = filter.state.offset("antenna_lever");
  PointPlace out = point_place(filter, antenna_B(filter, lever));
  if (lever >= 0) out.H.middleCols<3>(lever) = filter.state.nav.R_EU.toRotationMatrix() * filter.state.R_UB();
  return out;
}

PointVelocity antenna_velocity(const FilterView& filter) {
  const int lever = filter.state.offset("antenna_lever");
  PointVelocity out = point_velocity(filter, antenna_B(filter, lever));
  if (lever >= 0)
    out.H.middleCols<3>(lever) = filter.state.nav.R_EU.toRotationMatrix() * skew(filter.w_EU_U) * filter.state.R_UB();
  return out;
}

BodyAttitude body_attitude(const FilterView& filter) {
  const ErrorState& state = filter.state;
  BodyAttitude out{.R_EB = state.nav.R_EU.toRotationMatrix() * state.R_UB(),
                   .H = BodyRows::Zero(3, state.padded_size())};
  out.H.middleCols<3>(ErrorIndex::kTheta) = state.R_UB().transpose();
  if (state.mounting() >= 0) out.H.middleCols<3>(state.mounting()) = state.mounting_jacobian();
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
  turn_to_B(filter.state, out.a_B, out.H);
  return out;
}

PointAcceleration acceleration(const FilterView& filter) {
  const NavState& nav = filter.state.nav;
  const Eigen::Matrix3d R_EU = nav.R_EU.toRotationMatrix();
  PointAcceleration out{.a_E = R_EU * filter.f_U + gravity_E(nav.p_EU_E) - 2.0 * earth_rate_E().cross(nav.v_EU_E),
                        .H = BodyRows::Zero(3, filter.state.padded_size())};
  out.H.middleCols<3>(ErrorIndex::kTheta) = -R_EU * skew(filter.f_U);
  out.H.middleCols<3>(ErrorIndex::kPosition) = gravity_gradient_E(nav.p_EU_E);
  out.H.middleCols<3>(ErrorIndex::kVelocity) = -2.0 * skew(earth_rate_E());
  for (const Feed& feed : filter.state.feeds())
    if (feed.axis >= 3) out.H.col(feed.state) -= feed.rate * (R_EU * filter.imu.accel_inverse.col(feed.axis - 3));
  return out;
}

}  // namespace canyon::fusion
