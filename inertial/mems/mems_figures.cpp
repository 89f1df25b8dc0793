#include "canyon/inertial/mems/mems_figures.h"

#include "canyon/inertial/mems/integrator.h"

namespace canyon::inertial {

void visit(FieldVisitor& f, ElementFigures& c) {
  f.number("mass_kg", c.mass_kg, {1e-15, 1e-3}, "proof mass");
  f.number("resonance_hz", c.resonance_hz, {1, 1e7}, "of mass and spring; a gyroscope's sense mode");
  f.number("quality_factor", c.quality_factor, {1e-3, 1e7}, "Q");
  f.number("travel_m", c.travel_m, {1e-12, 1e-3}, "to the stops (accelerometer)");
  f.number("drive_amplitude_m", c.drive_amplitude_m, {1e-9, 1e-3}, "drive amplitude (gyroscope)");
  f.number("split_hz", c.split_hz, {-1e5, 1e5}, "sense minus drive resonance (gyroscope)");
  f.number("range", c.range, {0, 1e6}, "where the front end clips, g or deg/s; 0 = at the range of the sheet");
  f.number("bandwidth_hz", c.bandwidth_hz, {0, 1e6},
           "corner of the anti-alias filter; 0 = of the sheet, else 0.4 of the sample rate");
  f.integer("filter_order", c.filter_order, {0, 4}, "Butterworth order; 0 = none, samples are taken as they come");
  f.choice("pick_off", c.pick_off, model_names(pick_offs()), "how the displacement is read");
  f.group("pick_off_figures", c.pick_off_figures, "of the pick-off");
}

void visit(FieldVisitor& f, MemsFigures& c) {
  f.flag("given", c.given, "this entry can be used with the errors \"physics\"");
  f.number("temperature_k", c.temperature_k, {1, 1000}, "of the elements: thermal noise");
  f.choice("integrator", c.integrator, model_names(integrators()), "how the proof masses are carried over a sample");
  f.group("gyro", c.gyro, "gyroscope's sense mode");
  f.group("accel", c.accel, "accelerometer");
  f.text("source", c.source, "where these figures come from");
}

}  // namespace canyon::inertial
