#pragma once

#include <span>
#include <string>
#include <vector>

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// The rate of a pseudorange, from its Doppler.
struct RateMeasurement {
  Eigen::Vector3d p_E, v_E;  ///< satellite at transmission, in E of transmission
  double rate_m_s = 0.0;     ///< -Doppler x wavelength + c x rate of the satellite clock
  double sigma_m_s = 1.0;    ///< > 0
};

/// Rate of the pseudorange that a Doppler shift means: -doppler_hz c / carrier_hz (positive Doppler: approaching).
double pseudorange_rate_m_s(double doppler_hz, double carrier_hz);

/// Rate of the range between a satellite and a receiver at p_E that moves with v_E, m/s, by the receiver's clock.
/// Exact: the turning of E while the signal travels and the change of the travel time are in it, which neglected would
/// cost up to 2 cm/s. Of `m` only the satellite counts.
double range_rate_m_s(const RateMeasurement& m, const Eigen::Vector3d& p_E, const Eigen::Vector3d& v_E);

struct VelocitySolution {
  bool ok = false;
  std::string reason;
  Eigen::Vector3d v_E = Eigen::Vector3d::Constant(kNaN);
  double clock_drift_m_s = kNaN;                                   ///< rate of the receiver clock, times c
  Eigen::Matrix3d covariance_E = Eigen::Matrix3d::Constant(kNaN);  ///< of v_E, m^2/s^2
  std::vector<double> residuals_m_s;                               ///< measured minus fitted; empty if not ok
  std::vector<bool> used;                                          ///< false: left out as an outlier
};

struct VelocityParameters {
  double max_gdop = 100.0;
  /// Rates whose standardised residual exceeds this are left out one by one, the largest first, while five remain; a
  /// Doppler of a reflection alone is off by metres per second. 0: none.
  double outlier_sigmas = 0.0;
};

/// Weighted least squares for velocity and clock drift, which all systems share, for they hang on one oscillator. p_E:
/// the receiver, good to a kilometre (1 km errs by up to 0.2 m/s). Needs four satellites.
VelocitySolution solve_velocity(std::span<const RateMeasurement> rates, const Eigen::Vector3d& p_E,
                                const VelocityParameters& p = {});

}  // namespace canyon::gnss
