#include "canyon/inertial/motion/closed_form.h"

namespace canyon::inertial {

Result<PlacedMotion> make_stationary(const MotionConfig& config) {
  const double yaw = start_yaw_rad(config), pitch = config.pitch_deg * kDegree, roll = config.roll_deg * kDegree;
  return closed_form(config, [=](const Series&) { return kinematics({}, quaternion_from(yaw, pitch, roll)); });
}

}  // namespace canyon::inertial
