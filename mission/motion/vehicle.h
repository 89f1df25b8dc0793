#pragma once

#include <cstdint>

#include "canyon/core/messages.h"
#include "canyon/core/truth.h"
#include "canyon/mission/motion/road_roughness.h"
#include "canyon/mission/motion/side_slip.h"
#include "canyon/mission/motion/sprung_mass.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene.h"

namespace canyon::mission {

/// The true vehicle. Its steps are its own: they depend on no sensor. Over one of them acceleration and curvature are
/// linear in time, and heave, pitch and roll follow the ground under the wheels as sprung masses do, exactly; what lies
/// between the ends of steps is TrueMotion's. In the plan the rear axle rolls where it points, but for the slip of
/// linear tyres where the configuration has it (SideSlip); the vertical motion does not act on it.
class Vehicle {
 public:
  /// The fixed step of all true motion: the master step of a run. A road wave of 0.7 m, the shortest of ISO 8608, at
  /// 30 m/s is sampled more than twice.
  static constexpr std::int64_t kStep_ns = 10'000'000;

  /// Stands still at the start, body settled on the terrain. `scene` must outlive the vehicle.
  Vehicle(const VehicleConfig& config, const scene::Scene& scene, std::uint64_t seed, GpsTime start);

  /// Advances by one step under `command`, within the limits of speed, acceleration and steering. A negative speed is
  /// driven in reverse.
  const KinematicState& advance(const DriveCommand& command);

  const KinematicState& state() const { return state_; }
  double speed_m_s() const { return plan_.speed_0; }
  double distance_m() const { return distance_; }  ///< driven, either way
  /// False once a wheel has left the terrain.
  bool on_terrain() const { return on_terrain_; }
  const VehicleConfig& config() const { return config_; }

 private:
  struct Inputs {
    double heave_m, pitch_rad, roll_rad;
  };
  /// Over one step, tau from its beginning: the acceleration changes evenly, and so does the curvature.
  struct PlanMotion {
    double yaw_0 = 0, speed_0 = 0, curvature_0 = 0, acceleration_0 = 0, jerk = 0, curvature_rate = 0;
    SideSlip::Motion sideways{};

    double acceleration(double tau) const { return acceleration_0 + jerk * tau; }
    double speed(double tau) const { return speed_0 + (acceleration_0 + 0.5 * jerk * tau) * tau; }
    double curvature(double tau) const { return curvature_0 + curvature_rate * tau; }
    double yaw(double tau) const;
    double distance(double tau) const { return (speed_0 + (0.5 * acceleration_0 + jerk * tau / 6.0) * tau) * tau; }
    Eigen::Vector2d displacement(double tau) const;
    SideSlip::Drive drive(double tau) const;
  };
  double direction(const DriveCommand& command) const;
  PlanMotion planned(const DriveCommand& command, double dt_s) const;
  Inputs terrain_inputs(const Eigen::Vector2d& rear_axle, double yaw);
  KinematicState state_at(GpsTime t, const PlanMotion& plan, double tau) const;

  VehicleConfig config_;
  const scene::Scene& scene_;
  RoadRoughness roughness_;
  SideSlip slip_;
  KinematicState state_;
  Eigen::Vector2d p_;
  PlanMotion plan_;  ///< as the last step left it
  double distance_ = 0;
  bool on_terrain_ = true;
  Inputs last_inputs_;
  SprungMass heave_, pitch_, roll_;
};

}  // namespace canyon::mission
