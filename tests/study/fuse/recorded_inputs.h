#pragma once

#include <string>

#include "canyon/study/fuse/run.h"

/// The recordings of the shared data as inputs of study/fuse, and new draws of them.
namespace canyon::study::testing {

/// sim_leador_a15; the file is imu_ideal_100hz.f64 or one of a unit.
FuseInputs leador_inputs(const std::string& imu, const std::string& gnss, const std::string& truth);
/// navego_synthetic; the fixes with the velocities of the file.
FuseInputs navego_inputs(const std::string& imu, const std::string& gnss, const std::string& truth);
/// Ideal increments at 200 Hz along navego_synthetic's truth (a spline through it), and that truth.
FuseInputs ideal_navego_inputs(const std::string& gnss, const std::string& truth);

/// Configuration of sim_leador_a15's units as its MANIFEST gives them: white noise, Gauss-Markov biases with a
/// stationary start, scale factors. `start_deg`: 1-sigma of the first attitude, which is the truth's own.
struct LeadorUnit {
  const char* file;
  double arw_deg_per_sqrt_hr, vrw_m_s_per_sqrt_hr, gyro_bias_deg_per_hr, accel_bias_mgal, scale_ppm, tau_s;
};
extern const LeadorUnit kA15, kAdis16465;
FuseConfig leador_config(const LeadorUnit& unit, double start_deg);

/// The same drive with another draw of the unit's errors (on ideal samples) and of the fixes, by their covariances
/// about the true antenna. Both as `plan` tells the filter.
FuseInputs drawn(const FuseInputs& ideal, const FusePlan& plan, std::uint64_t seed);

/// A configuration of TOML.
FuseConfig config_of(const std::string& toml);

/// The mean over draws of mean-square error over mean variance, and half the width of its band: the spread over the
/// draws themselves, Student's quantile `t` of their number.
struct Ratio {
  double mean = 0.0, half_width = 0.0;
};
Ratio ratio_over(const std::vector<double>& draws, double t);

}  // namespace canyon::study::testing
