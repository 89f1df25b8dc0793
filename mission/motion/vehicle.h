#pragma once

#include <cstdint>
#include <memory>

#include "canyon/core/messages.h"
#include "canyon/core/truth.h"
#include "canyon/mission/motion/ground_contact.h"
#include "canyon/mission/motion/plan/plan_model.h"
#include "canyon/mission/motion/road_roughness.h"
#include "canyon/mission/motion/sprung_mass.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene.h"

namespace canyon::mission {

/// The true vehicle. Its steps are its own: they depend on no sensor. In the plan it moves as its model says
/// (plan/plan_model.h); heave, pitch and roll follow the ground under the wheels as sprung masses do, exactly, and do
/// not act on the plan. What lies between the ends of steps is TrueMotion's.
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
  double speed_m_s() const { return plan_->state().forward_m_s; }
  double distance_m() const { return plan_->state().distance_m; }  ///< driven, either way
  /// False once a wheel has left the terrain.
  bool on_terrain() const { return on_terrain_; }
  const VehicleConfig& config() const { return config_; }

 private:
  /// Off the terrain it stays as it was `before`.
  GroundContact follow_ground(const GroundContact& before);
  KinematicState state_at(GpsTime t) const;

  VehicleConfig config_;
  const scene::Scene& scene_;
  RoadRoughness roughness_;
  std::unique_ptr<PlanModel> plan_;
  KinematicState state_;
  bool on_terrain_ = true;
  GroundContact contact_;
  SprungMass heave_, pitch_, roll_;
};

}  // namespace canyon::mission
