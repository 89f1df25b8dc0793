#pragma once

#include <optional>

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene.h"

namespace canyon::mission {

/// X_WB of a vehicle that stands there, settled on the ground under its wheels: where Vehicle has it at a start without
/// roughness. The place is the rear axle's, x and y in W; the yaw counts from east, counter-clockwise. None where a
/// wheel stands on no terrain.
std::optional<Pose> body_at_rest(const VehicleConfig& vehicle, const scene::Scene& scene,
                                 const Eigen::Vector2d& rear_axle_W, double yaw_rad);

}  // namespace canyon::mission
