#pragma once

#include <string>

#include <Eigen/Core>

#include "canyon/core/config/config.h"

namespace canyon::mission {

/// [vehicle] of a mission file: a bicycle with a sprung body on the scene's terrain, kinematic but for the slip
/// of its tyres.
/// B sits at the centre of the rear axle at ground level, x forward, y left, z up.
struct VehicleConfig {
  Eigen::Vector2d start_m{0, 0};   ///< rear axle in W
  double start_heading_deg = 0.0;  ///< from true north, clockwise
  double wheelbase_m = 1.8;
  double track_m = 1.3;
  double length_m = 2.6;  ///< of the body, for collisions; rear overhang = (length - wheelbase) / 2
  double width_m = 1.5;
  double height_m = 1.6;
  double max_speed_m_s = 6.0;
  double max_reverse_m_s = 1.5;  ///< as fast a negative speed may be commanded; 0: it stands instead
  double max_acceleration_m_s2 = 1.5;
  double max_deceleration_m_s2 = 3.0;
  double max_steering_deg = 32.0;
  double max_steering_rate_deg_s = 45.0;
  /// Slip angle of the rear axle per lateral acceleration: 1 / (g x cornering coefficient). A tyre of 0.2 per degree
  /// (Gillespie 1992, chapter 6) has 0.51.
  double sideslip_deg_per_m_s2 = 0.0;
  double suspension_hz = 1.6;       ///< undamped natural frequency of heave, pitch and roll
  double suspension_damping = 0.6;  ///< damping ratio
  std::string roughness = "B";      ///< ISO 8608 road class, or "none"
};
void visit(FieldVisitor& f, VehicleConfig& c);

}  // namespace canyon::mission
