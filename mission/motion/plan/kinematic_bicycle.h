#pragma once

#include "canyon/mission/motion/plan/plan_model.h"

namespace canyon::mission {

/// Own keys of the model kinematic_bicycle.
struct KinematicBicycleParameters {
  /// Slip angle of the rear axle per lateral acceleration: 1 / (g x cornering coefficient). A tyre of 0.2 per degree
  /// (Gillespie 1992, chapter 6) has 0.51.
  double sideslip_deg_per_m_s2 = 0.0;
};
void visit(FieldVisitor& f, KinematicBicycleParameters& c);

}  // namespace canyon::mission
