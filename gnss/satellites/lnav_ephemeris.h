#pragma once

#include <optional>

#include "gnss/satellites/constellation.h"

namespace canyon::gnss {

/// One GPS LNAV ephemeris and clock record, SI and radians, names as in IS-GPS-200 table 20-III.
struct LnavEphemeris {
  SatelliteId sv;
  GpsTime toc, toe;
  double af0_s = 0.0, af1 = 0.0, af2_per_s = 0.0;
  double tgd_s = 0.0;
  double sqrt_a = 0.0;  ///< sqrt(m)
  double e = 0.0;       ///< [0, 1)
  double i0_rad = 0.0, idot_rad_s = 0.0;
  double omega0_rad = 0.0, omega_dot_rad_s = 0.0;
  double argument_of_perigee_rad = 0.0;
  double m0_rad = 0.0, delta_n_rad_s = 0.0;
  double cuc_rad = 0.0, cus_rad = 0.0, crc_m = 0.0, crs_m = 0.0, cic_rad = 0.0, cis_rad = 0.0;
  int iode = 0;
  int health = 0;  ///< 0 = healthy
  double fit_interval_s = 4.0 * 3600.0;
  double accuracy_m = 0.0;

  bool healthy() const { return health == 0; }
  /// t lies inside the fit interval, which is centred on toe.
  bool valid_at(GpsTime t) const;
  /// Position, velocity and clock by the user algorithm (IS-GPS-200 tables 20-IV and 20.3.3.3.3.1, L1 single frequency:
  /// the group delay is subtracted from the clock). Evaluates outside the fit interval too; the caller checks
  /// valid_at().
  SatelliteState at(GpsTime t) const;
};

/// The constellation that a set of broadcast records describes. For each satellite and time the record with the nearest
/// toe is taken (of several with the same toe, the last given); it must be healthy and t within its fit interval.
std::unique_ptr<Constellation> make_broadcast_gps(std::vector<LnavEphemeris> records);

}  // namespace canyon::gnss
