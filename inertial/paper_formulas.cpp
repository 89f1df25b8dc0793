#include "canyon/inertial/paper_formulas.h"

#include <cmath>

#include "canyon/core/units.h"

namespace canyon::inertial {

double accel_thermal_density(double temperature_k, double omega_0_rad_s, double mass_kg, double quality_factor) {
  return std::sqrt(4.0 * kBoltzmann * temperature_k * omega_0_rad_s / (mass_kg * quality_factor));
}

double gyro_thermal_as_printed_m(double quality_factor, double stiffness_n_m, double temperature_k,
                                 double resistance_kg_s, double bandwidth_hz) {
  return quality_factor / stiffness_n_m * std::sqrt(4.0 * kBoltzmann * temperature_k * resistance_kg_s * bandwidth_hz);
}

double gyro_thermal_density(double temperature_k, double omega_0_rad_s, double mass_kg, double quality_factor,
                            double drive_amplitude_m) {
  return std::sqrt(kBoltzmann * temperature_k / (mass_kg * omega_0_rad_s * quality_factor)) / drive_amplitude_m;
}

double quantization_as_printed(double quality_factor, double run_time_hr) {
  return 0.01745 * std::sqrt(3.0 * quality_factor * quality_factor / run_time_hr);
}

double recursion_as_printed(double previous, double tau_s, double sigma_0) {
  return previous / tau_s + sigma_0;
}

double recursion_correlation_time_s(double tau_s, double dt_s) {
  return dt_s / std::log(tau_s);
}

}  // namespace canyon::inertial
