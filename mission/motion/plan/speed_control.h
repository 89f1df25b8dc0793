#pragma once

#include <memory>

#include "canyon/core/messages.h"
#include "canyon/mission/motion/actuators/actuator.h"

namespace canyon::mission {

struct VehicleConfig;

/// Speed along B's x, step by step, as it is asked for and as far as the limits and the drive let it. In reverse all
/// that is said of speed and acceleration holds of their negatives; from one direction to the other it comes to a stop.
class SpeedControl {
 public:
  explicit SpeedControl(const VehicleConfig& config);

  /// Over one step, tau from its beginning: the acceleration changes evenly.
  struct Step {
    double speed_0 = 0.0, acceleration_0 = 0.0, jerk = 0.0;

    double acceleration(double tau) const { return acceleration_0 + jerk * tau; }
    double speed(double tau) const { return speed_0 + (acceleration_0 + 0.5 * jerk * tau) * tau; }
    double distance(double tau) const { return (speed_0 + (0.5 * acceleration_0 + jerk * tau / 6.0) * tau) * tau; }
  };
  /// What the command makes of the coming step.
  Step planned(const DriveCommand& command, double dt_s) const;
  /// +1 forwards, -1 in reverse: as it rolls, at rest as it is asked to.
  double direction(const DriveCommand& command) const;
  /// Goes to the end of a planned step. True: there it stands.
  bool end(const Step& step, double direction, double dt_s);

  double speed_m_s() const { return speed_m_s_; }
  double acceleration_m_s2() const { return acceleration_m_s2_; }

 private:
  double max_speed_m_s_, max_reverse_m_s_, max_acceleration_m_s2_, max_deceleration_m_s2_;
  std::unique_ptr<Actuator> drive_;
  double speed_m_s_ = 0.0, acceleration_m_s2_ = 0.0;
};

/// The angle of the front wheels that rolls along the curvature that is asked for, step by step, within its limits. For
/// a vehicle that does not steer by wheels it stands for the arcs that it may be asked for.
class SteeringControl {
 public:
  explicit SteeringControl(const VehicleConfig& config);

  /// After one step that began with the wheels at `steering_rad`.
  double after(double steering_rad, const DriveCommand& command, double dt_s) const;

 private:
  double wheelbase_m_, most_rad_;
  std::unique_ptr<Actuator> steering_;
};

}  // namespace canyon::mission
