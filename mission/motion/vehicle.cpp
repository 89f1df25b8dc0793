#include "canyon/mission/motion/vehicle.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::mission {

void visit(FieldVisitor& f, VehicleConfig& c) {
  f.vector2("start_m", c.start_m, {-1e5, 1e5}, "rear axle at the start, x and y in W");
  f.number("start_heading_deg", c.start_heading_deg, {-360, 360}, "from true north, clockwise");
  f.number("wheelbase_m", c.wheelbase_m, {0.3, 6}, "rear to front axle");
  f.number("track_m", c.track_m, {0.2, 3}, "left to right wheel");
  f.number("length_m", c.length_m, {0.3, 12}, "of the body, for collisions");
  f.number("width_m", c.width_m, {0.2, 3}, "of the body, for collisions");
  f.number("height_m", c.height_m, {0.3, 4}, "of the body, for collisions");
  f.number("max_speed_m_s", c.max_speed_m_s, {0.1, 30}, "limit");
  f.number("max_reverse_m_s", c.max_reverse_m_s, {0, 10}, "limit of a negative speed; 0: it stands instead");
  f.number("max_acceleration_m_s2", c.max_acceleration_m_s2, {0.1, 10}, "limit");
  f.number("max_deceleration_m_s2", c.max_deceleration_m_s2, {0.1, 10}, "limit");
  f.number("max_steering_deg", c.max_steering_deg, {5, 60}, "limit of the steering angle");
  f.number("max_steering_rate_deg_s", c.max_steering_rate_deg_s, {5, 360}, "limit of its rate");
  f.number("sideslip_deg_per_m_s2", c.sideslip_deg_per_m_s2, {0, 2},
           "slip angle of the rear axle per lateral acceleration, about 0.5 for a car's tyres; 0 = it rolls where it "
           "points");
  f.number("suspension_hz", c.suspension_hz, {0.3, 5}, "natural frequency of heave, pitch and roll");
  f.number("suspension_damping", c.suspension_damping, {0.05, 2}, "damping ratio");
  f.choice("roughness", c.roughness, RoadRoughness::classes(), "ISO 8608 road class");
}

double Vehicle::PlanMotion::yaw(double tau) const {
  const double c1 = speed_0 * curvature_0, c2 = acceleration_0 * curvature_0 + speed_0 * curvature_rate,
               c3 = 0.5 * jerk * curvature_0 + acceleration_0 * curvature_rate, c4 = 0.5 * jerk * curvature_rate;
  return yaw_0 + tau * (c1 + tau * (c2 / 2.0 + tau * (c3 / 3.0 + tau * c4 / 4.0)));
}

/// Gauss-Legendre quadrature of the plan velocity: five points, error below 1e-15 m at these rates.
Eigen::Vector2d Vehicle::PlanMotion::displacement(double tau) const {
  constexpr double kAbscissa[5] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                   0.9061798459386640};
  constexpr double kWeight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                 0.2369268850561891};
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < 5; ++i) {
    const double at = 0.5 * tau * (1.0 + kAbscissa[i]), direction = yaw(at);
    const Eigen::Vector2d forward(std::cos(direction), std::sin(direction)), left(-forward.y(), forward.x());
    sum += kWeight[i] * speed(at) * forward;
    sum += kWeight[i] * sideways.velocity(at) * left;
  }
  return 0.5 * tau * sum;
}

SideSlip::Drive Vehicle::PlanMotion::drive(double tau) const {
  const double forward = std::max(speed(tau), 0.0);
  return {forward, forward * forward * curvature(tau)};
}

Vehicle::Vehicle(const VehicleConfig& config, const scene::Scene& scene, std::uint64_t seed, GpsTime start)
    : config_(config),
      scene_(scene),
      roughness_(config.roughness, seed),
      slip_(config.sideslip_deg_per_m_s2 * kDegree),
      p_(config.start_m),
      plan_{.yaw_0 = yaw_from_heading(config.start_heading_deg * kDegree)},
      last_inputs_(terrain_inputs(p_, plan_.yaw_0)),
      heave_(2.0 * kPi * config.suspension_hz, config.suspension_damping, last_inputs_.heave_m),
      pitch_(2.0 * kPi * config.suspension_hz, config.suspension_damping, last_inputs_.pitch_rad),
      roll_(2.0 * kPi * config.suspension_hz, config.suspension_damping, last_inputs_.roll_rad) {
  state_ = state_at(start, plan_, 0.0);
}

Vehicle::Inputs Vehicle::terrain_inputs(const Eigen::Vector2d& rear_axle, double yaw) {
  const Eigen::Vector2d forward(std::cos(yaw), std::sin(yaw)), left(-forward.y(), forward.x());
  double height[4];
  for (int wheel = 0; wheel < 4; ++wheel) {
    const double along = wheel < 2 ? 0.0 : config_.wheelbase_m;
    const double across = (wheel % 2 == 0 ? 0.5 : -0.5) * config_.track_m;
    const Eigen::Vector2d contact = rear_axle + along * forward + across * left;
    const auto ground = scene_.ground(contact.x(), contact.y());
    if (!ground) {
      on_terrain_ = false;
      return last_inputs_;
    }
    height[wheel] = ground->height_m + roughness_.height_m(contact);
  }
  const double rear = 0.5 * (height[0] + height[1]), front = 0.5 * (height[2] + height[3]);
  const double left_side = 0.5 * (height[0] + height[2]), right_side = 0.5 * (height[1] + height[3]);
  // Pitch is positive nose down (right-handed about y left).
  return {rear, std::atan2(rear - front, config_.wheelbase_m), std::atan2(left_side - right_side, config_.track_m)};
}

KinematicState Vehicle::state_at(GpsTime t, const PlanMotion& plan, double tau) const {
  const double v = plan.speed(tau), kappa = plan.curvature(tau), yaw = plan.yaw(tau),
               acceleration = plan.acceleration(tau);
  const double yaw_rate = v * kappa, yaw_acceleration = acceleration * kappa + v * plan.curvature_rate;
  const SprungMass::State &heave = heave_.state(), &pitch = pitch_.state(), &roll = roll_.state();

  KinematicState state;
  state.t = t;
  const double c = std::cos(yaw), s = std::sin(yaw);
  state.X_WB = {rotation_from({yaw, pitch.x, roll.x}), {p_.x(), p_.y(), heave.x}};
  state.v_WB_W = {v * c, v * s, heave.v};
  state.a_WB_W = {acceleration * c - v * yaw_rate * s, acceleration * s + v * yaw_rate * c, heave.a};
  if (slip_.yields()) {
    const double across = plan.sideways.velocity(tau), changing = plan.sideways.acceleration(tau);
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

/// +1 forwards, -1 in reverse: as it rolls, at rest as it is asked to.
double Vehicle::direction(const DriveCommand& command) const {
  if (plan_.speed_0 != 0.0) return plan_.speed_0 > 0.0 ? 1.0 : -1.0;
  return command.speed_m_s < 0.0 && config_.max_reverse_m_s > 0.0 ? -1.0 : 1.0;
}

/// What the command makes of the plan motion over the coming step, as far as the limits allow. In reverse all that is
/// said of speed and acceleration holds of their negatives; from one direction to the other it comes to a stop.
Vehicle::PlanMotion Vehicle::planned(const DriveCommand& command, double dt_s) const {
  constexpr double kSpeedTime_s = 0.1;      // within which a difference of speed is to be made up
  constexpr double kStandstill_m_s = 1e-3;  // slower than this it comes to a true stop
  PlanMotion plan = plan_;
  const double sign = direction(command), speed = sign * plan.speed_0;
  const double fastest = sign > 0.0 ? config_.max_speed_m_s : config_.max_reverse_m_s;
  const double target = std::clamp(sign * command.speed_m_s, 0.0, fastest);
  const double acceleration =
      std::clamp((target - speed) / kSpeedTime_s, -config_.max_deceleration_m_s2, config_.max_acceleration_m_s2);
  plan.jerk = (sign * acceleration - plan.acceleration_0) / dt_s;
  if (target == 0.0 && sign * plan.speed(dt_s) < kStandstill_m_s) {
    plan.acceleration_0 = -plan.speed_0 / dt_s;
    plan.jerk = 0.0;
  }
  const double max_steering = config_.max_steering_deg * kDegree, max_rate = config_.max_steering_rate_deg_s * kDegree;
  const double steering = std::atan(plan.curvature_0 * config_.wheelbase_m);
  const double wanted = std::clamp(std::atan(command.curvature_1_m * config_.wheelbase_m), -max_steering, max_steering);
  const double next_steering = steering + std::clamp(wanted - steering, -max_rate * dt_s, max_rate * dt_s);
  plan.curvature_rate = (std::tan(next_steering) / config_.wheelbase_m - plan.curvature_0) / dt_s;
  return plan;
}

const KinematicState& Vehicle::advance(const DriveCommand& command) {
  CANYON_CHECK(std::isfinite(command.speed_m_s) && std::isfinite(command.curvature_1_m),
               "drive command from autonomy: speed ", command.speed_m_s, ", curvature ", command.curvature_1_m);
  constexpr double dt_s = 1e-9 * static_cast<double>(kStep_ns);
  PlanMotion plan = planned(command, dt_s);
  if (slip_.yields()) plan.sideways = slip_.advance(plan.drive(dt_s / 3.0), plan.drive(dt_s), dt_s);
  const double sign = direction(command);
  const bool stops = sign * plan.speed(dt_s) <= 0.0;

  p_ += plan.displacement(dt_s);
  distance_ += sign * plan.distance(dt_s);
  last_inputs_ = terrain_inputs(p_, plan.yaw(dt_s));
  heave_.advance(last_inputs_.heave_m, dt_s);
  pitch_.advance(last_inputs_.pitch_rad, dt_s);
  roll_.advance(last_inputs_.roll_rad, dt_s);

  if (stops) slip_.stop();
  plan_ = {.yaw_0 = wrap_pi(plan.yaw(dt_s)),
           .speed_0 = stops ? 0.0 : plan.speed(dt_s),
           .curvature_0 = plan.curvature(dt_s),
           .acceleration_0 = stops ? 0.0 : plan.acceleration(dt_s),
           .jerk = 0.0,
           .curvature_rate = plan.curvature_rate,
           .sideways = slip_.now()};
  state_ = state_at({state_.t.ns + kStep_ns}, plan_, 0.0);
  return state_;
}

}  // namespace canyon::mission
