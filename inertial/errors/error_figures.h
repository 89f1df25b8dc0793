#pragma once

namespace canyon::inertial {

/// Every figure of one triad that a link of the error chain takes, in SI: r is rad/s for a gyroscope, m/s^2 for an
/// accelerometer. 0: the unit has no such error, or none is known, and the link is not built.
struct TriadFigures {
  double white_per_sqrt_hz = 0.0;      ///< N of IEEE Std 952, r / sqrt(Hz)
  double neighbour_correlation = 0.0;  ///< of the white noise's samples, by a low-pass beyond one sample; 0 to 0.5
  double turn_on_bias = 0.0;           ///< r, 1-sigma
  double in_run_bias = 0.0;            ///< r, stationary sigma of the Gauss-Markov bias
  double in_run_bias_tau_s = 3600.0;
  double bias_instability = 0.0;  ///< r, floor of the Allan deviation: 0.664 B of IEEE Std 952
  double flicker_low_hz = 1e-5;   ///< corners between which the spectrum is 1/f
  double flicker_high_hz = 0.1;
  double rate_random_walk = 0.0;         ///< K of IEEE Std 952, r / sqrt(s)
  double ramp = 0.0;                     ///< R of IEEE Std 952, r / s
  double quantization_noise = 0.0;       ///< Q of IEEE Std 952, r s
  double scale = 0.0;                    ///< 1-sigma, dimensionless
  double scale_asymmetry = 0.0;          ///< 1-sigma, dimensionless
  double nonlinearity = 0.0;             ///< from the best straight line, as a part of the range
  double misalignment_rad = 0.0;         ///< each sensitive axis against the frame's, 1-sigma
  double package_rad = 0.0;              ///< the triad as a whole against the frame, each rotation, 1-sigma
  double cross_talk = 0.0;               ///< electrical, between channels, 1-sigma
  double g_sensitivity = 0.0;            ///< r per m/s^2, 1-sigma; gyroscope only
  double bias_temperature = 0.0;         ///< r / K, 1-sigma
  double scale_temperature = 0.0;        ///< 1 / K, 1-sigma
  double vibration_rectification = 0.0;  ///< r per (m/s^2)^2 of mean square
  double dead_band = 0.0;                ///< r
  double range = 0.0;                    ///< r; 0: no limit
  double resolution = 0.0;               ///< r, step of the output
};

/// Of the unit as a whole.
struct UnitFigures {
  TriadFigures gyro, accel;
  double reference_temperature_c = 25.0;  ///< where the bias and scale figures hold
  double latency_s = 0.0;
  double clock_skew = 0.0;      ///< 1-sigma, dimensionless
  double clock_jitter_s = 0.0;  ///< of each stamp, 1-sigma
  double loss_share = 0.0;      ///< samples that do not arrive / all, below 0.25
  double loss_length = 1.0;     ///< samples lost together, a whole number
};

}  // namespace canyon::inertial
