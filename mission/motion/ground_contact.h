#pragma once

#include <optional>

#include <Eigen/Core>

#include "canyon/mission/motion/road_roughness.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene.h"

namespace canyon::mission {

/// How four wheels on the ground would hold a body without springs.
struct GroundContact {
  double heave_m = 0.0;    ///< height of the rear axle's middle in W
  double pitch_rad = 0.0;  ///< positive nose down, right-handed about y left
  double roll_rad = 0.0;   ///< positive left side up, right-handed about x forward
};

/// Of a vehicle whose rear axle's middle is there, x and y in W; the yaw counts from east, counter-clockwise. The
/// ground is the scene's terrain, with `roughness` upon it unless that is null. None where a wheel stands on no
/// terrain.
std::optional<GroundContact> ground_contact(const VehicleConfig& vehicle, const scene::Scene& scene,
                                            const RoadRoughness* roughness, const Eigen::Vector2d& rear_axle_W,
                                            double yaw_rad);

}  // namespace canyon::mission
