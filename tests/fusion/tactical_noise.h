#pragma once

#include "canyon/core/imu_noise.h"

namespace canyon::fusion {

/// Figures of a good MEMS unit, every kind of error among them.
inline ImuNoise tactical_noise() {
  ImuNoise n;
  n.gyro = {.white_per_sqrt_hz = 4.4e-5,
            .turn_on_bias_sigma = 1.5e-5,
            .in_run_bias_sigma = 2.4e-6,
            .in_run_bias_tau_s = 1000.0,
            .scale_sigma = 5e-4,
            .misalignment_sigma_rad = 1e-3};
  n.accel = {.white_per_sqrt_hz = 1e-3,
             .turn_on_bias_sigma = 7e-3,
             .in_run_bias_sigma = 5e-4,
             .in_run_bias_tau_s = 1000.0,
             .scale_sigma = 3e-4,
             .misalignment_sigma_rad = 1e-3};
  return n;
}

}  // namespace canyon::fusion
