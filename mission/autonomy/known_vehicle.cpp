#include "canyon/mission/autonomy/known_vehicle.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/mission/motion/plan/skid_steer.h"

namespace canyon::mission {

KnownVehicle known_vehicle(const VehicleConfig& config) {
  const double rear_m = -0.5 * (config.length_m - config.wheelbase_m);
  const bool skids = config.model.name == "skid_steer";
  return {.rear_m = rear_m,
          .front_m = rear_m + config.length_m,
          .half_width_m = 0.5 * config.width_m,
          .wheelbase_m = config.wheelbase_m,
          .max_steering_rad = config.max_steering_deg * kDegree,
          .max_steering_rate_rad_s = config.max_steering_rate_deg_s * kDegree,
          .max_deceleration_m_s2 = config.max_deceleration_m_s2,
          .max_yaw_rate_rad_s = skids ? config.model.own.get<SkidSteerParameters>().max_turn_rate_deg_s * kDegree
                                      : std::numeric_limits<double>::infinity()};
}

double KnownVehicle::distance_m(const PlanPose& body, const Eigen::Vector2d& point) const {
  const Eigen::Vector2d u = body.forward(), d = point - body.p_m - 0.5 * (rear_m + front_m) * u;
  const double ahead = std::abs(u.dot(d)) - 0.5 * (front_m - rear_m),
               aside = std::abs(u.x() * d.y() - u.y() * d.x()) - half_width_m;
  return std::hypot(std::max(0.0, ahead), std::max(0.0, aside));
}

Eigen::Vector2d PlanPose::forward() const {
  return {std::cos(yaw_rad), std::sin(yaw_rad)};
}

PlanPose PlanPose::along(double kappa_1_m, double distance_m) const {
  const double turn = kappa_1_m * distance_m, middle = yaw_rad + 0.5 * turn;
  // The chord of an arc: sin(x) / x of half the turn, by its series where that is exact to 1e-17.
  const double x = 0.5 * turn, ratio = std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x;
  return {p_m + distance_m * ratio * Eigen::Vector2d(std::cos(middle), std::sin(middle)), yaw_rad + turn};
}

}  // namespace canyon::mission
