#pragma once

#include <memory>

#include "canyon/core/units.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/tests/inertial/smooth_path.h"

namespace canyon::testing {

/// SmoothPath as a motion of the generator, with an IMU off the body's origin.
inline inertial::PlacedMotion smooth_motion() {
  class SmoothMotion final : public inertial::Motion {
   public:
    KinematicState at(double t_s) const override { return path_.at(t_s); }

   private:
    SmoothPath path_{GpsTime{}};
  };
  return {.frame = LocalFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0}),
          .start = GpsTime::from_week_sow(1590, 396000.0),
          .lever_arm_m = {0.2, -0.1, 0.4},
          .motion = std::make_shared<SmoothMotion>()};
}

}  // namespace canyon::testing
