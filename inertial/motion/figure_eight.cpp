#include "canyon/inertial/motion/closed_form.h"

namespace canyon::inertial {

/// Lemniscate of Gerono, x = length / 2 sin u, y = width / 2 sin 2u along and across the axis, u = 2 pi t / period,
/// with waves of height and roll; the nose points along the track, also up and down.
Result<PlacedMotion> make_figure_eight(const MotionConfig& config) {
  const double axis = start_yaw_rad(config), rate = 2.0 * kPi / config.period_s;
  const double a = 0.5 * config.length_m, b = 0.5 * config.width_m;
  const double climb = config.climb_m, sway = config.sway_deg * kDegree;
  return closed_form(config, [=](const Series& t) {
    const Series u = Series(rate) * t;
    const Series x = Series(a) * sin(u), y = Series(b) * sin(Series(2.0) * u), z = Series(climb) * sin(Series(2.0) * u);
    const Series vx = x.derivative(), vy = y.derivative(), vz = z.derivative();
    const Series yaw = Series(axis) + atan2(vy, vx), pitch = -atan2(vz, sqrt(vx * vx + vy * vy));
    const double c = std::cos(axis), s = std::sin(axis);
    return kinematics({Series(c) * x - Series(s) * y, Series(s) * x + Series(c) * y, z},
                      quaternion_from(yaw, pitch, Series(sway) * sin(Series(3.0) * u)));
  });
}

}  // namespace canyon::inertial
