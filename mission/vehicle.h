#pragma once

#include <array>
#include <cstdint>

#include "core/config.h"
#include "core/messages.h"
#include "core/truth.h"
#include "mission/road_roughness.h"
#include "scene/scene.h"

namespace canyon::mission {

/// [vehicle] of a mission file: a kinematic bicycle with a sprung body on the scene's terrain.
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
  double max_acceleration_m_s2 = 1.5;
  double max_deceleration_m_s2 = 3.0;
  double max_steering_deg = 32.0;
  double max_steering_rate_deg_s = 45.0;
  double suspension_hz = 1.6;       ///< undamped natural frequency of heave, pitch and roll
  double suspension_damping = 0.6;  ///< damping ratio
  std::string roughness = "B";      ///< ISO 8608 road class, or "none"
};
void visit(FieldVisitor& f, VehicleConfig& c);

/// The true vehicle. Over one step speed and curvature are linear in time and the accelerations of heave, pitch and
/// roll are linear in time, so that position, velocity and acceleration at the nodes are exact derivatives of one
/// another: an ideal IMU integrates back to the truth to quadrature error. No slip: the vertical motion does not act on
/// the plan motion.
class Vehicle {
 public:
  /// Nodes of one step, equally spaced, both ends included.
  static constexpr int kNodes = 5;
  using Step = std::array<KinematicState, kNodes>;

  /// Stands still at the start, body settled on the terrain. `scene` must outlive the vehicle.
  Vehicle(const VehicleConfig& config, const scene::Scene& scene, std::uint64_t seed, GpsTime start);

  /// Advances to `t_end` under `command`, within the limits of speed, acceleration and steering.
  const Step& advance(const DriveCommand& command, GpsTime t_end);

  const KinematicState& state() const { return step_.back(); }
  double speed_m_s() const { return speed_; }
  double distance_m() const { return distance_; }
  /// False once a wheel has left the terrain.
  bool on_terrain() const { return on_terrain_; }
  const VehicleConfig& config() const { return config_; }

 private:
  /// One sprung degree of freedom: acceleration = w^2 (input - x) - 2 zeta w v.
  struct Sprung {
    double x = 0, v = 0, a = 0, a_next = 0;
  };
  struct Inputs {
    double heave_m, pitch_rad, roll_rad;
  };
  struct PlanMotion;
  Inputs terrain_inputs(const Eigen::Vector2d& rear_axle, double yaw);
  KinematicState node_state(GpsTime t, double tau, double dt, const PlanMotion& plan, const Eigen::Vector2d& p) const;

  VehicleConfig config_;
  const scene::Scene& scene_;
  RoadRoughness roughness_;
  Step step_;
  Eigen::Vector2d p_;
  double yaw_ = 0, speed_ = 0, curvature_ = 0, distance_ = 0;
  Sprung heave_, pitch_, roll_;
  Inputs last_inputs_{0, 0, 0};
  bool on_terrain_ = true;
};

}  // namespace canyon::mission
