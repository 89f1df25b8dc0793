#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

/// The same where E stands still.
void move_over_still_earth(NavState& state, const InertialStep& step, double dt_s, GravityFunction gravity_at,
                           const Eigen::Vector3d& bend_start_U) {
  const Eigen::Vector3d gravity = gravity_at(state.p_EU_E + 0.5 * dt_s * state.v_EU_E);
  const Eigen::Vector3d v_next = state.v_EU_E + state.R_EU * step.dv_start_U + gravity * dt_s;
  state.p_EU_E += 0.5 * dt_s * (state.v_EU_E + v_next) + state.R_EU * bend_start_U;
  state.v_EU_E = v_next;
  state.R_EU = (state.R_EU * so3_exp(step.rotation_U)).normalized();
  state.t = state.t + dt_s;
}

}  // namespace

void check_has_no_coning(const StrapdownOmissions& omissions) {
  CANYON_CHECK(!omissions.coning, "the integrator has no coning to leave out");
}

void move(NavState& state, const InertialStep& step, double dt_s, GravityFunction gravity_at, bool earth_turns,
          const Eigen::Vector3d& bend_start_U) {
  if (!earth_turns) return move_over_still_earth(state, step, dt_s, gravity_at, bend_start_U);
  const Eigen::Vector3d earth_rate = earth_rate_E();
  // E itself turns under U: a vector fixed in inertial space turns by -w_IE dt in E, half of it on average.
  const Eigen::Quaterniond half_turn = so3_exp(-0.5 * dt_s * earth_rate);
  const Eigen::Quaterniond turned = half_turn * state.R_EU;
  const Eigen::Matrix3d R = turned.toRotationMatrix();
  const Eigen::Vector3d dv_force = R * step.dv_start_U, bend = R * bend_start_U;

  // Gravity and Coriolis at mid-interval; a first guess of the velocity there is enough, its error enters times w_IE
  // dt.
  const Eigen::Vector3d& v = state.v_EU_E;
  const Eigen::Vector3d p_mid = state.p_EU_E + 0.5 * dt_s * v;
  const Eigen::Vector3d gravity = gravity_at(p_mid);
  const Eigen::Vector3d v_mid = v + 0.5 * (dv_force + (gravity - 2.0 * earth_rate.cross(v)) * dt_s);
  const Eigen::Vector3d v_next = v + dv_force + (gravity - 2.0 * earth_rate.cross(v_mid)) * dt_s;

  state.p_EU_E += 0.5 * dt_s * (v + v_next) + bend;
  state.v_EU_E = v_next;
  state.R_EU = (half_turn * turned * so3_exp(step.rotation_U)).normalized();
  state.t = state.t + dt_s;
}

}  // namespace canyon::fusion
