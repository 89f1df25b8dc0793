#pragma once

#include "canyon/core/config/config.h"

namespace canyon::lidar {

/// How a matt surface spreads the light that it sends back.
enum class MattReflection {
  kLambertian,  ///< evenly: with the cosine of the incidence
  kRough,       ///< Oren & Nayar: facets turned towards the sensor send more of it back at grazing incidence
};

/// Keys of what the energy of an echo depends on.
struct SignalConfig {
  double pulse_m = 0.75;                ///< length of the pulse, 5 ns (HDL-64E manual), as range
  double range_at_10_percent_m = 50.0;  ///< where a 10 % target square to the beam is at the detection threshold
  double full_overlap_m = 5.0;          ///< nearer, the signal is constant
  MattReflection reflection = MattReflection::kLambertian;
};
void visit(FieldVisitor& f, SignalConfig& c);

/// Energy received from a surface of apparent reflectivity 1 at range_m, in units of the detection threshold:
/// 10 (range_at_10_percent / range)^2. Nearer than full_overlap_m emitter and receiver look past each other in part,
/// which takes as much as nearness brings: the value there. That this is at 5 m is an assumption: makers do not tell.
double signal_gain(const SignalConfig& signal, double range_m);

/// Square of the range below which nearness brings no more energy (full_overlap_m), m^2: received energy is
/// reflectivity / max(range^2, this).
float full_overlap_m2(const SignalConfig& signal);

}  // namespace canyon::lidar
