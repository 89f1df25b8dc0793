#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/config.h"
#include "core/imu_noise.h"
#include "core/result.h"

namespace canyon::inertial {

/// One figure of a data sheet with where it was read.
struct Figure {
  double value = 0.0;
  std::string source;
};

/// One triad of a unit in the units data sheets use. Gyroscope: deg, hours; accelerometer: m/s per root hour, mg.
struct GyroSheet {
  Figure arw_deg_per_sqrt_hr;
  Figure turn_on_bias_deg_per_hr;
  Figure in_run_bias_deg_per_hr;
  Figure in_run_bias_tau_s{3600.0, ""};
  Figure scale_ppm;
  Figure misalignment_mrad;
};
struct AccelSheet {
  Figure vrw_m_s_per_sqrt_hr;
  Figure turn_on_bias_mg;
  Figure in_run_bias_mg;
  Figure in_run_bias_tau_s{3600.0, ""};
  Figure scale_ppm;
  Figure misalignment_mrad;
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
  GyroSheet gyro;
  AccelSheet accel;
  PaperParameters paper;

  /// The same figures in SI.
  ImuNoise noise() const;
};
void visit(FieldVisitor& f, CatalogueEntry& c);

/// Names of the built-in entries, sorted.
std::vector<std::string> catalogue_names();

/// A built-in entry by name, or a file if `sensor` ends in ".toml". An unknown name is an error that names the nearest
/// known one; a figure that is not zero and has no source is an error too.
Result<CatalogueEntry> load_catalogue_entry(const std::string& sensor);
Result<CatalogueEntry> parse_catalogue_entry(std::string_view toml, const std::string& file_name);

}  // namespace canyon::inertial
