#include "canyon/mission/motion/plan/speed_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/units.h"
#include "canyon/mission/motion/vehicle_config.h"

namespace canyon::mission {

SpeedControl::SpeedControl(const VehicleConfig& config)
    : max_speed_m_s_(config.max_speed_m_s),
      max_reverse_m_s_(config.max_reverse_m_s),
      max_acceleration_m_s2_(config.max_acceleration_m_s2),
      max_deceleration_m_s2_(config.max_deceleration_m_s2),
      drive_(model_row(drive_actuators(), config.drive.name)
                 .make(config.drive.own, std::numeric_limits<double>::infinity())) {}

double SpeedControl::direction(const DriveCommand& command) const {
  if (speed_m_s_ != 0.0) return speed_m_s_ > 0.0 ? 1.0 : -1.0;
  return command.speed_m_s < 0.0 && max_reverse_m_s_ > 0.0 ? -1.0 : 1.0;
}

SpeedControl::Step SpeedControl::planned(const DriveCommand& command, double dt_s) const {
  constexpr double kSpeedTime_s = 0.1;      // within which a difference of speed is to be made up
  constexpr double kCalm = 4.0;             // times the drive's lag: loop of the second order, critically damped
  constexpr double kStandstill_m_s = 1e-3;  // slower than this it comes to a true stop
  Step step{.speed_0 = speed_m_s_, .acceleration_0 = acceleration_m_s2_};
  const double sign = direction(command), speed = sign * step.speed_0;
  const double fastest = sign > 0.0 ? max_speed_m_s_ : max_reverse_m_s_;
  const double target = std::clamp(sign * command.speed_m_s, 0.0, fastest);
  const double within_s = std::max(kSpeedTime_s, kCalm * drive_->lag_s());
  const double acceleration = std::clamp((target - speed) / within_s, -max_deceleration_m_s2_, max_acceleration_m_s2_);
  step.jerk = (drive_->after(step.acceleration_0, sign * acceleration, dt_s) - step.acceleration_0) / dt_s;
  if (target == 0.0 && sign * step.speed(dt_s) < kStandstill_m_s) {
    step.acceleration_0 = -step.speed_0 / dt_s;
    step.jerk = 0.0;
  }
  return step;
}

bool SpeedControl::end(const Step& step, double direction, double dt_s) {
  const bool stops = direction * step.speed(dt_s) <= 0.0;
  speed_m_s_ = stops ? 0.0 : step.speed(dt_s);
  acceleration_m_s2_ = stops ? 0.0 : step.acceleration(dt_s);
  return stops;
}

SteeringControl::SteeringControl(const VehicleConfig& config)
    : wheelbase_m_(config.wheelbase_m),
      most_rad_(config.max_steering_deg * kDegree),
      steering_(model_row(steering_actuators(), config.steering.name)
                    .make(config.steering.own, config.max_steering_rate_deg_s * kDegree)) {}

double SteeringControl::after(double steering_rad, const DriveCommand& command, double dt_s) const {
  const double wanted = std::clamp(std::atan(command.curvature_1_m * wheelbase_m_), -most_rad_, most_rad_);
  return steering_->after(steering_rad, wanted, dt_s);
}

}  // namespace canyon::mission
