#include "canyon/lidar/lidar_config.h"

#include "canyon/lidar/deskew.h"

namespace canyon::lidar {

void visit(FieldVisitor& f, LidarConfig& c) {
  f.file("beams", c.beams, ".csv",
         "beam table: the name of a built-in one (vlp16, hdl32e, hdl64e, os1_64, os1_128, mid360, grid16), "
         "grid:LASERS:MIN_DEG:MAX_DEG, or the path of a .csv file");
  visit_choice(f, "model", c.model, with_rows("how a beam meets the scene", echo_models()).c_str());
  f.choice("see_through", c.see_through, see_through_rows(),
           with_rows("what light goes on behind", see_through_rows()).c_str());
  visit_choice(f, "detector", c.detector, with_rows("what the receiver makes of an echo", detectors()).c_str());
  f.number("rate_hz", c.rate_hz, {0.1, 100}, "revolutions (frames) per second");
  f.integer("azimuth_steps", c.azimuth_steps, {0, 100000},
            "firings of every laser per revolution; 0 = as fast as the beam table allows, whatever the head does");
  f.vector3("mount_m", c.mount_m, {-100, 100}, "position of the sensor in the body: forward, left, up");
  f.vector3("mount_yaw_pitch_roll_deg", c.mount_yaw_pitch_roll_deg, {-360, 360},
            "orientation of the sensor in the body");
  visit(f, c.report);
  f.number("range_noise_m", c.range_noise_m, {0, 10}, "1-sigma of the range noise, independent per ray");
  f.number("angle_noise_deg", c.angle_noise_deg, {0, 5},
           "1-sigma of a beam's true direction about the reported one, in each of two axes");
  f.number("latency_s", c.latency_s, {0, 1}, "how much later the time stamps are than the measurements");
  visit(f, c.crosstalk);
  visit(f, c.ego);
  f.number("wavelength_nm", c.wavelength_nm, {300, 2500}, "wavelength of the lasers");
  visit(f, c.signal);
  visit(f, c.texture);
  f.group("weather", c.weather, "what is in the air");
  f.choice("deskew", c.deskew, deskewing_names(),
           "by whose motion within a revolution scans are deskewed: the filter's prediction alone, its estimates with "
           "their corrections, nobody's, the true one");
  f.flag("blinded", c.blinded, "the sensor returns nothing (coupling studies)");
}

}  // namespace canyon::lidar
