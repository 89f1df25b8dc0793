#pragma once

#include <limits>

#include <Eigen/Core>

#include "canyon/mission/motion/vehicle_config.h"

namespace canyon::mission {

/// The pose of B on a level plane, as planning needs it.
struct PlanPose {
  Eigen::Vector2d p_m{0, 0};
  double yaw_rad = 0.0;

  Eigen::Vector2d forward() const;
  /// Along an arc of curvature kappa by a signed distance, exactly.
  PlanPose along(double kappa_1_m, double distance_m) const;
};

/// What an autonomy knows of the vehicle that it drives: its body's rectangle, from B (rear axle, at the ground), and
/// what it can do.
struct KnownVehicle {
  double rear_m = -0.4, front_m = 2.2;  ///< bumpers along B's x
  double half_width_m = 0.75;
  double wheelbase_m = 1.8;
  double max_steering_rad = 0.5585;
  double max_steering_rate_rad_s = 0.7854;
  double max_deceleration_m_s2 = 3.0;
  double max_yaw_rate_rad_s = std::numeric_limits<double>::infinity();
  double counted_wheel_left_m = 0.0;  ///< of the wheel that its odometer counts, along B's y

  /// From the body's rectangle at a pose to a point, m; 0 within.
  double distance_m(const PlanPose& body, const Eigen::Vector2d& point) const;
};
KnownVehicle known_vehicle(const VehicleConfig& config);

}  // namespace canyon::mission
