#pragma once

#include "canyon/mission/motion/plan/plan_model.h"
#include "canyon/mission/motion/plan/tyre.h"

namespace canyon::mission {

/// Own keys of the model dynamic_bicycle. All forces are per mass, so that no mass is needed: a cornering coefficient C
/// of 0.2 per degree is a stiffness of 0.2 times the load that the axle carries, per degree (Gillespie 1992, chapter
/// 6). Understeer gradient: 1 / (g C_front) - 1 / (g C_rear), in rad s^2/m.
struct DynamicBicycleParameters {
  ModelChoice<tyre_laws> tyres{"fiala"};
  double front_cornering_per_deg = 0.18, rear_cornering_per_deg = 0.2;
  double tyre_friction = 0.9;  ///< dry asphalt
  double gravity_centre_share = 0.5;
  double gravity_centre_height_m = 0.6;
  double yaw_inertia_ratio = 1.0;
};
void visit(FieldVisitor& f, DynamicBicycleParameters& c);

}  // namespace canyon::mission
