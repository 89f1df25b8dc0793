#pragma once

#include <cstdint>
#include <string>

#include "canyon/core/config/config.h"
#include "canyon/inertial/mems/pick_off.h"

namespace canyon::inertial {

/// One sensing element: a proof mass on a spring, its pick-off and electronics.
struct ElementFigures {
  double mass_kg = 1e-9;
  double resonance_hz = 5000.0;  ///< of mass and spring, without the pick-off's pull
  double quality_factor = 1.0;
  double travel_m = 1e-6;           ///< to the stops; accelerometer only
  double drive_amplitude_m = 5e-6;  ///< gyroscope only
  double split_hz = 0.0;            ///< sense minus drive resonance; gyroscope only
  double range = 0.0;               ///< where the front end clips, g or deg/s; 0: where the sheet says, if it does
  double bandwidth_hz = 0.0;        ///< corner of the anti-alias filter; 0: the sheet's, else 0.4 of the sample rate
  std::int64_t filter_order = 2;    ///< Butterworth, 0: none, the output is sampled as it is
  std::string pick_off = "capacitive";
  PickOffFigures pick_off_figures{};
};

/// Table [mems] of a catalogue entry.
struct MemsFigures {
  bool given = false;
  double temperature_k = 298.15;
  std::string integrator = "exact";
  ElementFigures gyro{.mass_kg = 1e-8, .resonance_hz = 10000.0, .quality_factor = 1000.0};
  ElementFigures accel;
  std::string source;
};
void visit(FieldVisitor& f, ElementFigures& c);
void visit(FieldVisitor& f, MemsFigures& c);

}  // namespace canyon::inertial
