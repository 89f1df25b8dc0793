#pragma once

#include <string>

#include "canyon/core/config/config.h"

namespace canyon::fusion {

/// Scale factors and misalignments of the IMU: estimated beside the 15 states if the IMU is said to have any, or
/// ignored (strictly 15 states, and too confident after turns).
enum class ImuGains { kEstimate, kIgnore };

/// [fusion] of a mission file.
struct FilterConfig {
  std::string imu;  ///< catalogue entry whose datasheet it is told; empty: that of [imu] sensor
  double initial_attitude_sigma_deg_roll_pitch = 0.1;
  double initial_attitude_sigma_deg_heading = 1.0;
  double initial_position_sigma_m = 0.5;
  double initial_velocity_sigma_m_s = 0.05;
  double gate_sigma = 0.0;         ///< innovation gate on NIS as a one-dimensional equivalent; 0 = accept every fix
  double fix_sigma_floor_m = 0.0;  ///< lower bound on a fix's 1-sigma per axis
  std::string integrator = "two_sample";  ///< a row of strapdown_models()
  ImuGains imu_gains = ImuGains::kEstimate;
  double imu_gain_tau_s = 0.0;  ///< correlation time of these gain errors (Gauss-Markov); 0: constant over a run
};
void visit(FieldVisitor& f, FilterConfig& c);

}  // namespace canyon::fusion
