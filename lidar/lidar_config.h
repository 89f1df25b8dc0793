#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "canyon/core/config/config.h"

namespace canyon::lidar {

/// [lidar.weather]: what is in the air between sensor and surfaces. Several may be at once; 0 = none.
struct WeatherConfig {
  double rain_mm_h = 0.0;
  std::string rain_law = "marshall_palmer";
  double fog_visibility_m = 0.0;
  std::string fog_law = "kruse";
  double snow_mm_h = 0.0;  ///< as water
  std::string snow_law = "wet";
  double dust_visibility_m = 0.0;
  bool false_returns = true;  ///< drops, flakes and dust also send light back
};
void visit(FieldVisitor& f, WeatherConfig& c);

/// [lidar] of a mission file.
struct LidarConfig {
  std::string beams = "vlp16";  ///< table in lidar/beams
  std::string model = "single_ray";
  std::string detector = "ideal";
  std::string returns = "strongest";
  double rate_hz = 10.0;                              ///< revolutions per second
  std::int64_t azimuth_steps = 1800;                  ///< firings per revolution; 0 = as fast as the lasers can
  Eigen::Vector3d mount_m{0.3, 0.0, 1.8};             ///< L in B
  Eigen::Vector3d mount_yaw_pitch_roll_deg{0, 0, 0};  ///< R_BL
  double min_range_m = 0.9;
  double max_range_m = 100.0;
  double range_noise_m = 0.02;  ///< 1-sigma; VLP-16 manual: +-3 cm typical accuracy
  double range_quantum_m = 0.002;
  double range_bias_m = 0.0;     ///< 1-sigma of each laser's constant bias
  double angle_noise_deg = 0.0;  ///< 1-sigma of the beam's true direction about the reported, each of two axes
  double latency_s = 0.0;        ///< the stamp is that much later than what was measured
  std::string see_through = "nothing";
  double crosstalk = 0.0;  ///< probability that a shot is answered by another sensor's pulse first
  Eigen::Vector3d ego_min_m{0, 0, 0}, ego_max_m{0, 0, 0};  ///< corners in B of what the sensor sees of its own vehicle
  double wavelength_nm = 905.0;
  Eigen::Vector2d divergence_mrad{3.0, 1.5};  ///< VLP-16 manual: full width, across and along the spin axis
  double pulse_m = 0.75;                      ///< 5 ns (HDL-64E manual), as range
  double range_at_10_percent_m = 50.0;
  double full_overlap_m = 5.0;
  double threshold_snr = 6.0;
  double saturation = 1000.0;
  double saturation_walk_m = 0.0;
  WeatherConfig weather;
  bool blinded = false;  ///< returns nothing (coupling studies)
};
void visit(FieldVisitor& f, LidarConfig& c);

/// Square of the range below which nearness brings no more energy (full_overlap_m), m^2: received energy is
/// reflectivity / max(range^2, this).
inline float full_overlap_m2(const LidarConfig& c) {
  const double overlap_m = c.full_overlap_m > 0.01 ? c.full_overlap_m : 0.01;
  return static_cast<float>(overlap_m * overlap_m);
}

}  // namespace canyon::lidar
