#include "gnss/satellites/lnav_ephemeris.h"

#include <cmath>

#include "gnss/satellites/kepler.h"
#include "gnss/signal.h"

namespace canyon::gnss {

bool LnavEphemeris::valid_at(GpsTime t) const {
  return std::abs(t - toe) <= 0.5 * fit_interval_s;
}

SatelliteState LnavEphemeris::at(GpsTime t) const {
  const double tk_s = t - toe;
  const double a_m = sqrt_a * sqrt_a;
  const double n_rad_s = std::sqrt(kGpsMu / (a_m * a_m * a_m)) + delta_n_rad_s;
  const double E = eccentric_anomaly(m0_rad + n_rad_s * tk_s, e);
  const double sin_E = std::sin(E), cos_E = std::cos(E);
  const double E_dot = n_rad_s / (1.0 - e * cos_E);

  const double root = std::sqrt(1.0 - e * e);
  const double phi = std::atan2(root * sin_E, cos_E - e) + argument_of_perigee_rad;
  const double phi_dot = root * E_dot / (1.0 - e * cos_E);
  const double s2 = std::sin(2.0 * phi), c2 = std::cos(2.0 * phi);

  const double u = phi + cus_rad * s2 + cuc_rad * c2;
  const double u_dot = phi_dot * (1.0 + 2.0 * (cus_rad * c2 - cuc_rad * s2));
  const double r = a_m * (1.0 - e * cos_E) + crs_m * s2 + crc_m * c2;
  const double r_dot = a_m * e * sin_E * E_dot + 2.0 * phi_dot * (crs_m * c2 - crc_m * s2);
  const double i = i0_rad + idot_rad_s * tk_s + cis_rad * s2 + cic_rad * c2;
  const double i_dot = idot_rad_s + 2.0 * phi_dot * (cis_rad * c2 - cic_rad * s2);
  const double node_dot = omega_dot_rad_s - kGpsEarthRate;
  const double node = omega0_rad + node_dot * tk_s - kGpsEarthRate * toe.sow_s();

  const double x = r * std::cos(u), y = r * std::sin(u);  // in the orbital plane
  const double x_dot = r_dot * std::cos(u) - y * u_dot, y_dot = r_dot * std::sin(u) + x * u_dot;
  const double sin_i = std::sin(i), cos_i = std::cos(i), sin_n = std::sin(node), cos_n = std::cos(node);

  SatelliteState s;
  s.p_E = {x * cos_n - y * cos_i * sin_n, x * sin_n + y * cos_i * cos_n, y * sin_i};
  s.v_E = {x_dot * cos_n - y_dot * cos_i * sin_n + y * sin_i * sin_n * i_dot - s.p_E.y() * node_dot,
           x_dot * sin_n + y_dot * cos_i * cos_n - y * sin_i * cos_n * i_dot + s.p_E.x() * node_dot,
           y_dot * sin_i + y * cos_i * i_dot};
  const double tc_s = t - toc;
  s.clock_s = af0_s + af1 * tc_s + af2_per_s * tc_s * tc_s + kGpsRelativity * e * sqrt_a * sin_E;
  s.group_delay_s[1] = tgd_s;
  s.group_delay_s[2] = tgd_s * std::pow(kL1Hz / carrier_hz(GnssSystem::kGps, 2), 2);  // IS-GPS-200 20.3.3.3.3.2
  s.clock_rate = af1 + 2.0 * af2_per_s * tc_s + kGpsRelativity * e * sqrt_a * cos_E * E_dot;
  return s;
}

}  // namespace canyon::gnss
