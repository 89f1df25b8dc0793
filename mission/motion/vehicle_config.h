#pragma once

#include <string>

#include <Eigen/Core>

#include "canyon/core/config/config.h"
#include "canyon/core/model_choice.h"
#include "canyon/mission/motion/actuators/actuator.h"
#include "canyon/mission/motion/plan/plan_model.h"

namespace canyon::mission {

/// [vehicle] of a mission file: how it moves in the plane, its actuators, its body and limits, and the springs between
/// body and terrain.
/// B sits at the centre of the rear axle at ground level, x forward, y left, z up.
struct VehicleConfig {
  std::string preset;  ///< of mission/vehicles, or a file; its figures lie below what stands beside it
  ModelChoice<plan_models> model{"kinematic_bicycle"};
  ModelChoice<steering_actuators> steering{"rate_limit"};
  ModelChoice<drive_actuators> drive{"direct"};
  Eigen::Vector2d start_m{0, 0};   ///< rear axle in W
  double start_heading_deg = 0.0;  ///< from true north, clockwise
  double wheelbase_m = 1.8;
  double track_m = 1.3;
  double length_m = 2.6;  ///< of the body, for collisions; rear overhang = (length - wheelbase) / 2
  double width_m = 1.5;
  double height_m = 1.6;
  double ground_clearance_m = 0.2;  ///< what is lower it drives over
  double max_speed_m_s = 6.0;
  double max_reverse_m_s = 1.5;  ///< as fast a negative speed may be commanded; 0: it stands instead
  double max_acceleration_m_s2 = 1.5;
  double max_deceleration_m_s2 = 3.0;
  double max_steering_deg = 32.0;
  double max_steering_rate_deg_s = 45.0;
  double suspension_hz = 1.6;       ///< undamped natural frequency of heave, pitch and roll
  double suspension_damping = 0.6;  ///< damping ratio
  std::string roughness = "B";      ///< ISO 8608 road class, or "none"
};
void visit(FieldVisitor& f, VehicleConfig& c);

}  // namespace canyon::mission
