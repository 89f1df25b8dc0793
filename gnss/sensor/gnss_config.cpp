#include "canyon/gnss/sensor/gnss_config.h"

namespace canyon::gnss {

void visit(FieldVisitor& f, GnssConfig& c) {
  visit_choice(f, "model", c.model, "how a fix is made");
  f.file("receiver", c.receiver, ".toml",
         "entry of the catalogue of receivers, or a TOML file of your own: its figures take the place of what is set "
         "for the keys that describe a receiver, those that stand beside this key excepted; empty = the keys alone");
  f.number("rate_hz", c.rate_hz, {0.01, 50.0}, "fixes per second");
  f.number("mask_deg", c.mask_deg, {0.0, 60.0}, "satellites below this elevation are not used");
  f.vector3("lever_arm_m", c.lever_arm_m, {-50.0, 50.0}, "antenna in the vehicle's frame B (x forward, y left, z up)");

  visit_choice(f, "mode", c.mode, "what the receiver corrects");
  visit_choice(f, "ionosphere", c.ionosphere, "ionospheric delay");
  visit_choice(f, "troposphere", c.troposphere, "tropospheric delay");
  visit_choice(f, "ephemeris_error", c.ephemeris_error, "error of the broadcast orbit and satellite clock");
  visit_choice(f, "receiver_clock", c.receiver_clock, "receiver clock error");

  visit(f, c.propagation);
  visit(f, c.reception);
  visit(f, c.link);
  visit(f, c.tracking);
  visit(f, c.locks);
  visit(f, c.cn0_report);
  visit(f, c.position);
  visit(f, c.satellites);
}

}  // namespace canyon::gnss
