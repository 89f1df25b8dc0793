#include "canyon/inertial/motion/closed_form.h"

namespace canyon::inertial {

/// q = [cos a/2, sin a/2 cos Wt, sin a/2 sin Wt, 0] after the turn to the heading: the body's z on a cone of half angle
/// a about the vertical, while the body does not turn about it (Goodman & Robinson 1958).
Result<PlacedMotion> make_coning(const MotionConfig& config) {
  const double a = config.cone_deg * kDegree, rate = 2.0 * kPi * config.cone_hz, yaw = start_yaw_rad(config);
  return closed_form(config, [=](const Series& t) {
    const SineCosine turn = sine_cosine(Series(rate) * t);
    KinematicState heading;
    heading.X_WB.R = rotation_from({yaw, 0.0, 0.0});
    const double s = std::sin(0.5 * a);
    return compose(heading,
                   kinematics({}, {Series(std::cos(0.5 * a)), Series(s) * turn.cosine, Series(s) * turn.sine, 0.0}));
  });
}

}  // namespace canyon::inertial
