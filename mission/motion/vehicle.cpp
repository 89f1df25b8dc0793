#include "canyon/mission/motion/vehicle.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::mission {

void visit(FieldVisitor& f, VehicleConfig& c) {
  f.file(
      "preset", c.preset, ".toml",
      "entry of the catalogue of vehicles, or a TOML file of your own: its figures take the place of what is set for "
      "the keys that describe a vehicle, those that stand beside this key excepted; empty = the keys alone");
  visit_choice(f, "model", c.model, "how it moves in the plane");
  visit_choice(f, "steering", c.steering, "what its wheels make of the steering angle asked for");
  visit_choice(f, "drive", c.drive, "what it makes of the acceleration asked for");
  f.vector2("start_m", c.start_m, {-1e5, 1e5}, "rear axle at the start, x and y in W");
  f.number("start_heading_deg", c.start_heading_deg, {-360, 360}, "from true north, clockwise");
  f.number("wheelbase_m", c.wheelbase_m, {0.3, 6}, "rear to front axle");
  f.number("track_m", c.track_m, {0.2, 3}, "left to right wheel");
  f.number("length_m", c.length_m, {0.3, 12}, "of the body, for collisions");
  f.number("width_m", c.width_m, {0.2, 3}, "of the body, for collisions");
  f.number("height_m", c.height_m, {0.3, 4}, "of the body, for collisions");
  f.number("ground_clearance_m", c.ground_clearance_m, {0.02, 1},
           "of the body, for collisions of the whole body; what is lower it drives over");
  f.number("max_speed_m_s", c.max_speed_m_s, {0.1, 30}, "limit");
  f.number("max_reverse_m_s", c.max_reverse_m_s, {0, 10}, "limit of a negative speed; 0: it stands instead");
  f.number("max_acceleration_m_s2", c.max_acceleration_m_s2, {0.1, 10}, "limit");
  f.number("max_deceleration_m_s2", c.max_deceleration_m_s2, {0.1, 10}, "limit");
  f.number("max_steering_deg", c.max_steering_deg, {5, 60}, "limit of the steering angle");
  f.number("max_steering_rate_deg_s", c.max_steering_rate_deg_s, {5, 360}, "limit of its rate");
  f.number("suspension_hz", c.suspension_hz, {0.3, 5}, "natural frequency of heave, pitch and roll");
  f.number("suspension_damping", c.suspension_damping, {0.05, 2}, "damping ratio");
  f.choice("roughness", c.roughness, RoadRoughness::classes(), "ISO 8608 road class");
}

Vehicle::Vehicle(const VehicleConfig& config, const scene::Scene& scene, std::uint64_t seed, GpsTime start)
    : config_(config),
      scene_(scene),
      roughness_(config.roughness, seed),
      plan_(model_row(plan_models(), config.model.name).make(config.model.own, config)),
      contact_(follow_ground({})),
      heave_(2.0 * kPi * config.suspension_hz, config.suspension_damping, contact_.heave_m),
      pitch_(2.0 * kPi * config.suspension_hz, config.suspension_damping, contact_.pitch_rad),
      roll_(2.0 * kPi * config.suspension_hz, config.suspension_damping, contact_.roll_rad) {
  state_ = state_at(start);
}

GroundContact Vehicle::follow_ground(const GroundContact& before) {
  const PlanState& plan = plan_->state();
  const auto contact = ground_contact(config_, scene_, &roughness_, plan.p_W, plan.yaw_rad);
  if (!contact) on_terrain_ = false;
  return contact.value_or(before);
}

KinematicState Vehicle::state_at(GpsTime t) const {
  const PlanState& plan = plan_->state();
  const double v = plan.forward_m_s, acceleration = plan.forward_change_m_s2, yaw_rate = plan.turn_rad_s,
               yaw_acceleration = plan.turn_change_rad_s2;
  const SprungMass::State &heave = heave_.state(), &pitch = pitch_.state(), &roll = roll_.state();

  KinematicState state;
  state.t = t;
  const double yaw = wrap_pi(plan.yaw_rad);
  const double c = std::cos(yaw), s = std::sin(yaw);
  state.X_WB = {rotation_from({yaw, pitch.x, roll.x}), {plan.p_W.x(), plan.p_W.y(), heave.x}};
  state.v_WB_W = {v * c, v * s, heave.v};
  state.a_WB_W = {acceleration * c - v * yaw_rate * s, acceleration * s + v * yaw_rate * c, heave.a};
  if (plan_->slips()) {
    const double across = plan.across_m_s, changing = plan.across_change_m_s2;
    state.v_WB_W += Eigen::Vector3d(-across * s, across * c, 0.0);
    state.a_WB_W += Eigen::Vector3d(-changing * s - across * yaw_rate * c, changing * c - across * yaw_rate * s, 0.0);
  }
  // Body rates of R = Rz(yaw) Ry(pitch) Rx(roll), and their derivatives.
  const double sp = std::sin(pitch.x), cp = std::cos(pitch.x), sr = std::sin(roll.x), cr = std::cos(roll.x);
  state.w_WB_B = {roll.v - yaw_rate * sp, pitch.v * cr + yaw_rate * sr * cp, -pitch.v * sr + yaw_rate * cr * cp};
  state.alpha_WB_B = {roll.a - yaw_acceleration * sp - yaw_rate * cp * pitch.v,
                      pitch.a * cr - pitch.v * sr * roll.v + yaw_acceleration * sr * cp +
                          yaw_rate * (cr * cp * roll.v - sr * sp * pitch.v),
                      -pitch.a * sr - pitch.v * cr * roll.v + yaw_acceleration * cr * cp +
                          yaw_rate * (-sr * cp * roll.v - cr * sp * pitch.v)};
  return state;
}

const KinematicState& Vehicle::advance(const DriveCommand& command) {
  CANYON_CHECK(std::isfinite(command.speed_m_s) && std::isfinite(command.curvature_1_m),
               "drive command from autonomy: speed ", command.speed_m_s, ", curvature ", command.curvature_1_m);
  constexpr double dt_s = 1e-9 * static_cast<double>(kStep_ns);
  plan_->advance(command, dt_s);
  contact_ = follow_ground(contact_);
  heave_.advance(contact_.heave_m, dt_s);
  pitch_.advance(contact_.pitch_rad, dt_s);
  roll_.advance(contact_.roll_rad, dt_s);
  state_ = state_at({state_.t.ns + kStep_ns});
  return state_;
}

}  // namespace canyon::mission
