#pragma once

#include "canyon/gnss/satellites/constellation.h"

namespace canyon::gnss {

/// One GLONASS FDMA record: a state vector at t_b to be integrated by the user, names as in the GLONASS ICD (L1, L2,
/// edition 5.1, 2008). PZ-90.11 agrees with WGS84 to a few centimetres; before September 2007 PZ-90 was off by 0.4 m,
/// which is not corrected.
struct GlonassEphemeris {
  SatelliteId sv;
  GpsTime toe;  ///< t_b in GPS time
  Eigen::Vector3d p_E = Eigen::Vector3d::Zero(), v_E = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_E = Eigen::Vector3d::Zero();  ///< acceleration by the Sun and the Moon, m/s^2
  double clock_s = 0.0;      ///< -tau_n: satellite clock minus GLONASS time at t_b, relativity included
  double clock_rate = 0.0;   ///< gamma_n
  double delta_tau_s = 0.0;  ///< delay of the G2 signal after the G1 signal; 0 where not told
  int frequency_channel = 0;
  int health = 0;  ///< 0 = healthy
  double age_days = 0.0;

  bool healthy() const { return health == 0; }
  /// The ICD's half interval of 15 minutes around t_b, and 5 more: records come every 30 minutes of UTC, and a user may
  /// miss the change of frames.
  static constexpr double kValidS = 20.0 * 60.0;
  bool valid_at(GpsTime t) const;
  /// Runge-Kutta of fourth order in steps of 60 s from t_b (ICD A.3.1.2) with central gravity, J2, the turning of E and
  /// the constant a_E. Evaluates outside valid_at() too, up to a day; beyond that throws.
  SatelliteState at(GpsTime t) const;
};

}  // namespace canyon::gnss
