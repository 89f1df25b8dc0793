#pragma once

#include "canyon/core/model_choice.h"

namespace canyon::mission {

/// How much side force a tyre gives for its slip, both per vertical load: an axle's force is this times the load that
/// it carries. Cornering coefficients are in 1/rad, slips are tangents of the slip angle.
struct TyreForce {
  double share = 0.0;  ///< of the load; against the slip
  double slope = 0.0;  ///< its derivative by the slip
};

/// `cornering_1_rad` > 0: share per slip angle where that is small. `friction` > 0: the most that the share can be.
using TyreLaw = TyreForce(double slip, double cornering_1_rad, double friction);
ModelTable<TyreLaw> tyre_laws();

/// In proportion to the slip angle, up to what friction holds.
TyreForce linear_tyre(double slip, double cornering_1_rad, double friction);
/// The brush model with a parabola of pressure: E. Fiala, Seitenkraefte am rollenden Luftreifen, VDI-Zeitschrift 96,
/// 1954; in the form of Pacejka, Tyre and Vehicle Dynamics, 3rd ed. 2012, eq. 3.11. It slides from a slip of 3 friction
/// / cornering on.
TyreForce fiala_tyre(double slip, double cornering_1_rad, double friction);

}  // namespace canyon::mission
