#include "canyon/mission/collision/body_at_rest.h"

#include <array>
#include <cmath>

namespace canyon::mission {

std::optional<Pose> body_at_rest(const VehicleConfig& vehicle, const scene::Scene& scene,
                                 const Eigen::Vector2d& rear_axle_W, double yaw_rad) {
  const Eigen::Vector2d forward(std::cos(yaw_rad), std::sin(yaw_rad)), left(-forward.y(), forward.x());
  std::array<double, 4> height_m{};  // rear left, rear right, front left, front right
  for (std::size_t wheel = 0; wheel < height_m.size(); ++wheel) {
    const Eigen::Vector2d contact = rear_axle_W + (wheel < 2 ? 0.0 : vehicle.wheelbase_m) * forward +
                                    (wheel % 2 == 0 ? 0.5 : -0.5) * vehicle.track_m * left;
    const auto ground = scene.ground(contact.x(), contact.y());
    if (!ground) return std::nullopt;
    height_m[wheel] = ground->height_m;
  }
  const double rear_m = 0.5 * (height_m[0] + height_m[1]), front_m = 0.5 * (height_m[2] + height_m[3]);
  const double left_m = 0.5 * (height_m[0] + height_m[2]), right_m = 0.5 * (height_m[1] + height_m[3]);
  // Pitch is positive nose down.
  return Pose{rotation_from({yaw_rad, std::atan2(rear_m - front_m, vehicle.wheelbase_m),
                             std::atan2(left_m - right_m, vehicle.track_m)}),
              {rear_axle_W.x(), rear_axle_W.y(), rear_m}};
}

}  // namespace canyon::mission
