#pragma once

#include "canyon/mission/motion/plan/plan_model.h"

namespace canyon::mission {

/// Own keys of the model skid_steer.
struct SkidSteerParameters {
  double slip_track_ratio = 1.5;  ///< distance of the centres about which the two sides slip, over the track
  double slip_centre_share = 0.5;
  double side_acceleration_m_s2 = 3.0;
  double max_turn_rate_deg_s = 120.0;
};
void visit(FieldVisitor& f, SkidSteerParameters& c);

}  // namespace canyon::mission
