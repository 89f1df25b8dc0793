#include "canyon/lidar/lidar_config.h"

#include "canyon/lidar/beam/echo_model.h"
#include "canyon/lidar/beam/see_through.h"
#include "canyon/lidar/beam/weather.h"
#include "canyon/lidar/receiver/detector.h"
#include "canyon/lidar/receiver/return_choice.h"

namespace canyon::lidar {
namespace {

/// "how a beam meets the scene: single_ray = ..., footprint = ..."
template <class Row>
void choice(FieldVisitor& f, const char* key, std::string& value, const std::vector<Row>& rows, std::string doc) {
  std::vector<std::string> names;
  for (const Row& row : rows) {
    doc += (names.empty() ? ": " : "; ") + std::string(row.name) + " = " + row.doc;
    names.emplace_back(row.name);
  }
  f.choice(key, value, names, doc.c_str());
}

}  // namespace

void visit(FieldVisitor& f, WeatherConfig& c) {
  f.number("rain_mm_h", c.rain_mm_h, {0, 500}, "rain rate; 0 = none");
  choice(f, "rain_law", c.rain_law, rain_laws(), "extinction by rain");
  f.number("fog_visibility_m", c.fog_visibility_m, {0, 1e5}, "visibility in fog or haze (2 % contrast); 0 = none");
  choice(f, "fog_law", c.fog_law, fog_laws(), "how extinction depends on visibility and wavelength");
  f.number("snow_mm_h", c.snow_mm_h, {0, 100}, "snowfall as water; 0 = none");
  choice(f, "snow_law", c.snow_law, snow_laws(), "extinction by snow");
  f.number("dust_visibility_m", c.dust_visibility_m, {0, 1e5}, "visibility in dust; 0 = none");
  f.flag("false_returns", c.false_returns, "drops, flakes and dust also send light back");
}

void visit(FieldVisitor& f, LidarConfig& c) {
  f.file("beams", c.beams, ".csv",
         "beam table: the name of a built-in one (vlp16, hdl32e, hdl64e, os1_64, os1_128, mid360, grid16), "
         "grid:LASERS:MIN_DEG:MAX_DEG, or the path of a .csv file");
  choice(f, "model", c.model, echo_models(), "how a beam meets the scene");
  choice(f, "see_through", c.see_through, see_through_rows(), "what light goes on behind");
  choice(f, "detector", c.detector, detectors(), "what the receiver makes of an echo");
  choice(f, "returns", c.returns, return_modes(), "which echoes of a shot are reported");
  f.number("rate_hz", c.rate_hz, {0.1, 100}, "revolutions (frames) per second");
  f.integer("azimuth_steps", c.azimuth_steps, {0, 100000},
            "firings of every laser per revolution; 0 = as fast as the beam table allows, whatever the head does");
  f.vector3("mount_m", c.mount_m, {-100, 100}, "position of the sensor in the body: forward, left, up");
  f.vector3("mount_yaw_pitch_roll_deg", c.mount_yaw_pitch_roll_deg, {-360, 360},
            "orientation of the sensor in the body");
  f.number("min_range_m", c.min_range_m, {0, 1e4}, "shorter measured ranges are not reported");
  f.number("max_range_m", c.max_range_m, {0, 1e4}, "longer measured ranges are not reported");
  f.number("range_noise_m", c.range_noise_m, {0, 10}, "1-sigma of the range noise, independent per ray");
  f.number("range_quantum_m", c.range_quantum_m, {0, 1}, "step of the reported range; 0 = continuous");
  f.number("range_bias_m", c.range_bias_m, {0, 10}, "1-sigma of the constant range bias of each laser");
  f.number("angle_noise_deg", c.angle_noise_deg, {0, 5},
           "1-sigma of a beam's true direction about the reported one, in each of two axes");
  f.number("latency_s", c.latency_s, {0, 1}, "how much later the time stamps are than the measurements");
  f.number("crosstalk", c.crosstalk, {0, 1}, "probability that another sensor's pulse is among a shot's echoes");
  f.vector3("ego_min_m", c.ego_min_m, {-100, 100}, "box in the body that hides the vehicle itself: lowest corner");
  f.vector3("ego_max_m", c.ego_max_m, {-100, 100}, "its highest corner; the same as ego_min_m = no box");
  f.number("wavelength_nm", c.wavelength_nm, {300, 2500}, "wavelength of the lasers");
  f.vector2("divergence_mrad", c.divergence_mrad, {0, 100},
            "full width of the beam at 1/e^2 of its middle: along the turn of the head and along its axis (footprint)");
  f.number("pulse_m", c.pulse_m, {1e-3, 100}, "length of the pulse as range, half of it in space; nearer echoes merge");
  f.number("range_at_10_percent_m", c.range_at_10_percent_m, {0.1, 1e5},
           "where a 10 % target square to the beam is at the detection threshold (radiometric, false returns)");
  f.number(
      "full_overlap_m", c.full_overlap_m, {0, 1e3},
      "from where on the receiver sees the whole beam; nearer, the signal is constant (radiometric, false returns)");
  f.number("threshold_snr", c.threshold_snr, {0.1, 1e3}, "detection threshold over the receiver's noise (radiometric)");
  f.number("saturation", c.saturation, {1, 1e9}, "signal over threshold from which the receiver clips (radiometric)");
  f.number("saturation_walk_m", c.saturation_walk_m, {0, 10},
           "how much a clipped range reads short, for every factor of ten (radiometric)");
  f.group("weather", c.weather, "what is in the air");
  f.flag("blinded", c.blinded, "the sensor returns nothing (coupling studies)");
}

}  // namespace canyon::lidar
