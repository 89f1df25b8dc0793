#pragma once

#include "canyon/core/config/config.h"
#include "canyon/core/units.h"

namespace canyon {

/// Noise of one triad as a datasheet states it, SI per root hertz. Generator and filter share it, so that they agree.
struct TriadNoise {
  double white_per_sqrt_hz = 0.0;  ///< ARW in rad/s/sqrt(Hz), VRW in m/s^2/sqrt(Hz); two-sided convention N of IEEE 952
  double turn_on_bias_sigma = 0.0;    ///< constant over a run, rad/s or m/s^2
  double in_run_bias_sigma = 0.0;     ///< stationary sigma of the first-order Gauss-Markov bias
  double in_run_bias_tau_s = 3600.0;  ///< its correlation time
  double scale_sigma = 0.0;           ///< scale-factor error, 1-sigma, dimensionless (1e-6 = 1 ppm)
  double misalignment_sigma_rad = 0.0;
};

struct ImuNoise {
  TriadNoise gyro;
  TriadNoise accel;
};

}  // namespace canyon
