#include "mission/vehicle.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/units.h"

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
  f.number("max_acceleration_m_s2", c.max_acceleration_m_s2, {0.1, 10}, "limit");
  f.number("max_deceleration_m_s2", c.max_deceleration_m_s2, {0.1, 10}, "limit");
  f.number("max_steering_deg", c.max_steering_deg, {5, 60}, "limit of the steering angle");
  f.number("max_steering_rate_deg_s", c.max_steering_rate_deg_s, {5, 360}, "limit of its rate");
  f.number("suspension_hz", c.suspension_hz, {0.3, 5}, "natural frequency of heave, pitch and roll");
  f.number("suspension_damping", c.suspension_damping, {0.05, 2}, "damping ratio");
  f.choice("roughness", c.roughness, RoadRoughness::classes(), "ISO 8608 road class");
}

/// Over one step, tau from its beginning: v(tau) = v0 + a tau, kappa(tau) = kappa0 + k' tau, yaw' = v kappa.
struct Vehicle::PlanMotion {
  double yaw_0, speed_0, curvature_0, acceleration, curvature_rate;

  double speed(double tau) const { return speed_0 + acceleration * tau; }
  double curvature(double tau) const { return curvature_0 + curvature_rate * tau; }
  double yaw(double tau) const {
    return yaw_0 + speed_0 * curvature_0 * tau +
           0.5 * (acceleration * curvature_0 + speed_0 * curvature_rate) * tau * tau +
           acceleration * curvature_rate * tau * tau * tau / 3.0;
  }
};

Vehicle::Vehicle(const VehicleConfig& config, const scene::Scene& scene, std::uint64_t seed, GpsTime start)
    : config_(config),
      scene_(scene),
      roughness_(config.roughness, seed),
      p_(config.start_m),
      yaw_(yaw_from_heading(config.start_heading_deg * kDegree)) {
  last_inputs_ = terrain_inputs(p_, yaw_);
  heave_.x = last_inputs_.heave_m;
  pitch_.x = last_inputs_.pitch_rad;
  roll_.x = last_inputs_.roll_rad;
  step_.fill(node_state(start, 0.0, 1.0, {yaw_, 0.0, 0.0, 0.0, 0.0}, p_));
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

KinematicState Vehicle::node_state(GpsTime t, double tau, double dt, const PlanMotion& plan,
                                   const Eigen::Vector2d& p) const {
  const double v = plan.speed(tau), kappa = plan.curvature(tau), yaw = plan.yaw(tau), acceleration = plan.acceleration;
  const double yaw_rate = v * kappa, yaw_acceleration = acceleration * kappa + v * plan.curvature_rate;

  // Sprung motion: acceleration linear over the step.
  struct Value {
    double x, v, a;
  };
  const auto at = [&](const Sprung& s) {
    const double jerk = (s.a_next - s.a) / dt;
    return Value{s.x + tau * (s.v + tau * (0.5 * s.a + tau * jerk / 6.0)), s.v + tau * (s.a + 0.5 * tau * jerk),
                 s.a + tau * jerk};
  };
  const Value heave = at(heave_), pitch = at(pitch_), roll = at(roll_);

  KinematicState state;
  state.t = t;
  const double c = std::cos(yaw), s = std::sin(yaw);
  state.X_WB = {rotation_from({yaw, pitch.x, roll.x}), {p.x(), p.y(), heave.x}};
  state.v_WB_W = {v * c, v * s, heave.v};
  state.a_WB_W = {acceleration * c - v * yaw_rate * s, acceleration * s + v * yaw_rate * c, heave.a};
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

const Vehicle::Step& Vehicle::advance(const DriveCommand& command, GpsTime t_end) {
  const GpsTime t_start = step_.back().t;
  const double dt = t_end - t_start;
  CANYON_CHECK(dt > 0, "dt = ", dt);
  CANYON_CHECK(std::isfinite(command.speed_m_s) && std::isfinite(command.curvature_1_m),
               "drive command from autonomy: speed ", command.speed_m_s, ", curvature ", command.curvature_1_m);

  // Constant acceleration and steering rate over the step, as far as the limits allow.
  const double target_speed = std::clamp(command.speed_m_s, 0.0, config_.max_speed_m_s);
  double acceleration = std::clamp((target_speed - speed_) / std::max(dt, 0.1), -config_.max_deceleration_m_s2,
                                   config_.max_acceleration_m_s2);
  if (speed_ + acceleration * dt < 1e-3 && target_speed == 0.0) acceleration = -speed_ / dt;  // comes to a true stop
  const double max_steering = config_.max_steering_deg * kDegree, max_rate = config_.max_steering_rate_deg_s * kDegree;
  const double steering = std::atan(curvature_ * config_.wheelbase_m);
  const double wanted = std::clamp(std::atan(command.curvature_1_m * config_.wheelbase_m), -max_steering, max_steering);
  const double next_steering = steering + std::clamp(wanted - steering, -max_rate * dt, max_rate * dt);
  const double curvature_rate = (std::tan(next_steering) / config_.wheelbase_m - curvature_) / dt;
  const PlanMotion plan{yaw_, speed_, curvature_, acceleration, curvature_rate};

  // Plan position at the nodes by Gauss-Legendre quadrature (5 points: error below 1e-15 m at these rates).
  constexpr double kAbscissa[5] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                   0.9061798459386640};
  constexpr double kWeight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                 0.2369268850561891};
  const auto plan_velocity = [&](double tau) {
    const double yaw = plan.yaw(tau);
    return Eigen::Vector2d(plan.speed(tau) * Eigen::Vector2d(std::cos(yaw), std::sin(yaw)));
  };
  std::array<Eigen::Vector2d, kNodes> p;
  p[0] = p_;
  const double h = dt / (kNodes - 1);
  for (int i = 1; i < kNodes; ++i) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int j = 0; j < 5; ++j) sum += kWeight[j] * plan_velocity((i - 1) * h + 0.5 * h * (1.0 + kAbscissa[j]));
    p[static_cast<std::size_t>(i)] = p[static_cast<std::size_t>(i - 1)] + 0.5 * h * sum;
  }

  // Sprung accelerations at the end of the step: springs towards the terrain there, from the predicted state.
  const double end_yaw = plan.yaw(dt);
  const Inputs inputs = terrain_inputs(p.back(), end_yaw);
  const double w = 2.0 * kPi * config_.suspension_hz, zeta = config_.suspension_damping;
  const auto spring = [&](Sprung& s, double input, double previous_input) {
    // Damped relative to the moving ground, as a shock absorber is.
    const double input_rate = (input - previous_input) / dt;
    const double x = s.x + dt * (s.v + 0.5 * dt * s.a), v = s.v + dt * s.a;
    s.a_next = w * w * (input - x) + 2.0 * zeta * w * (input_rate - v);
  };
  spring(heave_, inputs.heave_m, last_inputs_.heave_m);
  spring(pitch_, inputs.pitch_rad, last_inputs_.pitch_rad);
  spring(roll_, inputs.roll_rad, last_inputs_.roll_rad);
  last_inputs_ = inputs;

  for (int i = 0; i < kNodes; ++i) {
    const double tau = i * h;
    const GpsTime t = i == kNodes - 1 ? t_end : t_start + tau;
    step_[static_cast<std::size_t>(i)] = node_state(t, tau, dt, plan, p[static_cast<std::size_t>(i)]);
  }

  distance_ += speed_ * dt + 0.5 * acceleration * dt * dt;
  p_ = p.back();
  yaw_ = wrap_pi(end_yaw);
  speed_ = std::max(0.0, speed_ + acceleration * dt);
  curvature_ += curvature_rate * dt;
  for (Sprung* s : {&heave_, &pitch_, &roll_}) {
    const double jerk = (s->a_next - s->a) / dt;
    s->x += dt * (s->v + dt * (0.5 * s->a + dt * jerk / 6.0));
    s->v += dt * (s->a + 0.5 * dt * jerk);
    s->a = s->a_next;
  }
  return step_;
}

}  // namespace canyon::mission
