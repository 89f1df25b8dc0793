#include "canyon/mission/motion/ground_contact.h"

#include <array>
#include <cmath>

namespace canyon::mission {

std::optional<GroundContact> ground_contact(const VehicleConfig& vehicle, const scene::Scene& scene,
                                            const RoadRoughness* roughness, const Eigen::Vector2d& rear_axle_W,
                                            double yaw_rad) {
  const Eigen::Vector2d forward(std::cos(yaw_rad), std::sin(yaw_rad)), left(-forward.y(), forward.x());
  std::array<double, 4> height_m{};  // rear left, rear right, front left, front right
  for (std::size_t wheel = 0; wheel < height_m.size(); ++wheel) {
    const double along_m = wheel < 2 ? 0.0 : vehicle.wheelbase_m;
    const double across_m = (wheel % 2 == 0 ? 0.5 : -0.5) * vehicle.track_m;
    const Eigen::Vector2d contact = rear_axle_W + along_m * forward + across_m * left;
    const auto ground = scene.ground(contact.x(), contact.y());
    if (!ground) return std::nullopt;
    height_m[wheel] = ground->height_m;
    if (roughness != nullptr) height_m[wheel] += roughness->height_m(contact);
  }
  const double rear_m = 0.5 * (height_m[0] + height_m[1]), front_m = 0.5 * (height_m[2] + height_m[3]);
  const double left_m = 0.5 * (height_m[0] + height_m[2]), right_m = 0.5 * (height_m[1] + height_m[3]);
  return GroundContact{.heave_m = rear_m,
                       .pitch_rad = std::atan2(rear_m - front_m, vehicle.wheelbase_m),
                       .roll_rad = std::atan2(left_m - right_m, vehicle.track_m)};
}

}  // namespace canyon::mission
