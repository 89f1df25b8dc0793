#include "canyon/mission/collision/body_at_rest.h"

#include "canyon/mission/motion/ground_contact.h"

namespace canyon::mission {

std::optional<Pose> body_at_rest(const VehicleConfig& vehicle, const scene::Scene& scene,
                                 const Eigen::Vector2d& rear_axle_W, double yaw_rad) {
  const auto on = ground_contact(vehicle, scene, nullptr, rear_axle_W, yaw_rad);
  if (!on) return std::nullopt;
  return Pose{rotation_from({yaw_rad, on->pitch_rad, on->roll_rad}), {rear_axle_W.x(), rear_axle_W.y(), on->heave_m}};
}

}  // namespace canyon::mission
