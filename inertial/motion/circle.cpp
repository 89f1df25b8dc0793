#include "canyon/inertial/motion/closed_form.h"

namespace canyon::inertial {

/// From W's origin; the centre lies radius_m to the left.
Result<PlacedMotion> make_circle(const MotionConfig& config) {
  const double yaw = start_yaw_rad(config), radius = config.radius_m, rate = config.speed_m_s / config.radius_m;
  const double pitch = config.pitch_deg * kDegree, roll = config.roll_deg * kDegree;
  return closed_form(config, [=](const Series& t) {
    const Series now = Series(yaw) + Series(rate) * t;
    const SineCosine turn = sine_cosine(now);
    return kinematics(
        {Series(radius) * (turn.sine - std::sin(yaw)), Series(radius) * (Series(std::cos(yaw)) - turn.cosine), 0.0},
        quaternion_from(now, pitch, roll));
  });
}

}  // namespace canyon::inertial
