#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/config/config.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/result.h"
#include "canyon/inertial/errors/error_figures.h"
#include "canyon/inertial/mems/mems_figures.h"

namespace canyon::inertial {

/// One figure of a data sheet with where it was read.
struct Figure {
  double value = 0.0;
  std::string source;
};

/// One triad of a unit in the units data sheets use. Gyroscope: deg, hours; accelerometer: m/s per root hour, mg. What
/// each figure does is said in inertial/errors/error_figures.h; docs/inertial.md lists the keys. Figures that a file
/// does not give are zero, except the first five of each, which must be given.
struct GyroSheet {
  Figure arw_deg_per_sqrt_hr;
  Figure neighbour_correlation;
  Figure turn_on_bias_deg_per_hr;
  Figure in_run_bias_deg_per_hr;
  Figure in_run_bias_tau_s{3600.0, ""};
  Figure scale_ppm;
  Figure misalignment_mrad;
  Figure bias_instability_deg_per_hr;
  Figure flicker_low_hz{1e-5, ""}, flicker_high_hz{0.1, ""};
  Figure rate_random_walk_deg_per_hr_per_sqrt_hr;
  Figure ramp_deg_per_hr_per_hr;
  Figure quantization_noise_deg;
  Figure scale_asymmetry_ppm;
  Figure nonlinearity_percent;
  Figure package_misalignment_mrad;
  Figure cross_talk_percent;
  Figure g_sensitivity_deg_per_hr_per_g;
  Figure bias_temperature_deg_per_hr_per_k;
  Figure scale_temperature_ppm_per_k;
  Figure vibration_rectification_deg_per_hr_per_g2;
  Figure dead_band_deg_per_s;
  Figure range_deg_per_s;
  Figure resolution_deg_per_s;
  Figure bandwidth_hz;  ///< of the output, -3 dB; for the reader and the proof-mass models, no link takes it
};
struct AccelSheet {
  Figure vrw_m_s_per_sqrt_hr;
  Figure neighbour_correlation;
  Figure turn_on_bias_mg;
  Figure in_run_bias_mg;
  Figure in_run_bias_tau_s{3600.0, ""};
  Figure scale_ppm;
  Figure misalignment_mrad;
  Figure bias_instability_mg;
  Figure flicker_low_hz{1e-5, ""}, flicker_high_hz{0.1, ""};
  Figure rate_random_walk_mg_per_sqrt_hr;
  Figure ramp_mg_per_hr;
  Figure quantization_noise_m_s;
  Figure scale_asymmetry_ppm;
  Figure nonlinearity_percent;
  Figure package_misalignment_mrad;
  Figure cross_talk_percent;
  Figure bias_temperature_mg_per_k;
  Figure scale_temperature_ppm_per_k;
  Figure vibration_rectification_mg_per_g2;
  Figure dead_band_mg;
  Figure range_g;
  Figure resolution_mg;
  Figure bandwidth_hz;
};
/// The unit as a whole.
struct UnitSheet {
  Figure reference_temperature_c{25.0, ""};
  Figure latency_ms;
  Figure clock_skew_ppm;
  Figure clock_jitter_us;
  Figure loss_percent;
  Figure loss_length{1.0, ""};
};

/// Parameters of the error chain of Durst & Goodin 2012, sections 2.2 and 3 (see inertial/paper_formulas.h).
struct PaperTriad {
  double quality_factor = 1.0;     ///< Q of the resonator
  double mass_kg = 1e-8;           ///< proof mass
  double resonance_hz = 5000.0;    ///< fundamental frequency of the spring-mass system
  double drive_amplitude_m = 0.0;  ///< gyroscope only
  double bandwidth_hz = 100.0;     ///< noise bandwidth B of the gyroscope's thermal noise as printed
  double white_process = 0.0;      ///< "white noise process coefficient": spread of the recursion, deg/s or m/s^2
  double zero_offset = 0.0;        ///< sigma_0, "mean offset from zero", every axis, deg/s or m/s^2
  double quantization = 0.0;       ///< corrected quantization coefficient (IEEE Std 952), deg or m/s
};
struct PaperParameters {
  bool given = false;  ///< the entry has a [paper] table
  double temperature_k = 285.0;
  double correlation_time_s = 10.0;
  double run_time_hr = 0.5;  ///< "total run time of the sensor" in the quantization term
  PaperTriad gyro, accel;
  std::string source;
};

/// A unit of the catalogue: inertial/catalogue/NAME.toml.
struct CatalogueEntry {
  std::string name;
  std::string description;
  bool has_gyroscope = true;  ///< false: an accelerometer alone, without a [gyro] table
  /// The Gauss-Markov bias stands for the same measured floor as `bias_instability`; a chain with flicker noise then
  /// leaves it out. A fit that finds both processes in a log says false.
  bool in_run_bias_is_instability = true;
  GyroSheet gyro;
  AccelSheet accel;
  UnitSheet unit;
  PaperParameters paper;
  MemsFigures mems;

  /// What a filter is told, in SI.
  ImuNoise noise() const;
  /// What the links of the error chain take, in SI.
  UnitFigures figures() const;
};
void visit(FieldVisitor& f, CatalogueEntry& c);

/// Names of the built-in entries, sorted.
std::vector<std::string> catalogue_names();

/// A built-in entry by name, or a file if `sensor` ends in ".toml". An unknown name is an error that names the nearest
/// known one; a figure that is not zero and has no source is an error too, and so is one that must be given and is not.
Result<CatalogueEntry> load_catalogue_entry(const std::string& sensor);
Result<CatalogueEntry> parse_catalogue_entry(std::string_view toml, const std::string& file_name);

}  // namespace canyon::inertial
