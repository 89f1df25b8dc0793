#pragma once

#include "canyon/inertial/catalogue.h"
#include "canyon/inertial/environment.h"

namespace canyon::testing {}
namespace canyon::inertial::testing {
using namespace canyon::testing;  // so that testing:: is both

/// A unit that has every error there is, of the size of a consumer part's.
inline CatalogueEntry every_link() {
  CatalogueEntry e;
  e.name = "every_link";
  e.gyro.arw_deg_per_sqrt_hr.value = 0.3;
  e.gyro.turn_on_bias_deg_per_hr.value = 100.0;
  e.gyro.in_run_bias_deg_per_hr.value = 5.0;
  e.gyro.in_run_bias_tau_s.value = 100.0;
  e.gyro.scale_ppm.value = 1000.0;
  e.gyro.misalignment_mrad.value = 1.0;
  e.gyro.bias_instability_deg_per_hr.value = 3.0;
  e.gyro.rate_random_walk_deg_per_hr_per_sqrt_hr.value = 2.0;
  e.gyro.ramp_deg_per_hr_per_hr.value = 10.0;
  e.gyro.quantization_noise_deg.value = 1e-4;
  e.gyro.scale_asymmetry_ppm.value = 200.0;
  e.gyro.nonlinearity_percent.value = 0.1;
  e.gyro.package_misalignment_mrad.value = 5.0;
  e.gyro.cross_talk_percent.value = 0.5;
  e.gyro.g_sensitivity_deg_per_hr_per_g.value = 30.0;
  e.gyro.bias_temperature_deg_per_hr_per_k.value = 20.0;
  e.gyro.scale_temperature_ppm_per_k.value = 40.0;
  e.gyro.vibration_rectification_deg_per_hr_per_g2.value = 1.0;
  e.gyro.dead_band_deg_per_s.value = 1e-3;
  e.gyro.range_deg_per_s.value = 450.0;
  e.gyro.resolution_deg_per_s.value = 0.00625;
  e.accel.vrw_m_s_per_sqrt_hr.value = 0.05;
  e.accel.turn_on_bias_mg.value = 5.0;
  e.accel.in_run_bias_mg.value = 0.05;
  e.accel.in_run_bias_tau_s.value = 100.0;
  e.accel.scale_ppm.value = 1000.0;
  e.accel.misalignment_mrad.value = 1.0;
  e.accel.bias_instability_mg.value = 0.03;
  e.accel.rate_random_walk_mg_per_sqrt_hr.value = 0.1;
  e.accel.ramp_mg_per_hr.value = 0.1;
  e.accel.quantization_noise_m_s.value = 1e-5;
  e.accel.scale_asymmetry_ppm.value = 200.0;
  e.accel.nonlinearity_percent.value = 0.2;
  e.accel.package_misalignment_mrad.value = 5.0;
  e.accel.cross_talk_percent.value = 0.5;
  e.accel.bias_temperature_mg_per_k.value = 0.1;
  e.accel.scale_temperature_ppm_per_k.value = 40.0;
  e.accel.vibration_rectification_mg_per_g2.value = 0.05;
  e.accel.dead_band_mg.value = 0.1;
  e.accel.range_g.value = 10.0;
  e.accel.resolution_mg.value = 0.25;
  e.in_run_bias_is_instability = false;  // both processes
  e.unit.latency_ms.value = 12.0;
  e.unit.clock_skew_ppm.value = 20.0;
  e.unit.clock_jitter_us.value = 50.0;
  e.unit.loss_percent.value = 2.0;
  e.unit.loss_length.value = 3.0;
  return e;
}

/// Where it is: warming up, on an engine.
inline Environment warming_up() {
  return {.temperature_times_s = {0.0, 600.0, 1200.0},
          .temperatures_c = {15.0, 40.0, 45.0},
          .vibration_rms_m_s2 = {5.0, 5.0, 10.0}};
}

}  // namespace canyon::inertial::testing
