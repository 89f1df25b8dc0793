#pragma once

#include <memory>

#include "canyon/core/units.h"
#include "canyon/inertial/motion/models.h"
#include "canyon/inertial/motion/rigid_motion.h"

namespace canyon::inertial {

/// A motion in closed form that lasts for ever: `Form` has `KinematicState operator()(Series t) const`.
template <class Form>
PlacedMotion closed_form(const MotionConfig& config, Form form) {
  class ClosedForm final : public Motion {
   public:
    explicit ClosedForm(Form f) : form_(std::move(f)) {}
    KinematicState at(double t_s) const override { return form_(Series::time(t_s)); }

   private:
    Form form_;
  };
  return {.frame = frame_of(config), .motion = std::make_shared<ClosedForm>(std::move(form))};
}

inline double start_yaw_rad(const MotionConfig& config) {
  return (90.0 - config.heading_deg) * kDegree;
}

}  // namespace canyon::inertial
