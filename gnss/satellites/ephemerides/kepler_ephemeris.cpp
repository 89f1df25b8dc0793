#include "canyon/gnss/satellites/ephemerides/kepler_ephemeris.h"

#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/satellites/ephemerides/kepler.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

using Message = NavigationMessage;

double squared_ratio(GnssSystem system, int band) {
  const double ratio = carrier_hz(system, 1) / carrier_hz(system, band);
  return ratio * ratio;
}

/// Position and velocity in the frame in which the node stands still but for its own drift: E as it stood at toe, or,
/// with the turning of the Earth in node_dot, E itself.
struct OrbitPoint {
  Eigen::Vector3d p, v;
};

OrbitPoint turned_about_node(double x, double y, double x_dot, double y_dot, double node, double node_dot, double i,
                             double i_dot) {
  const double sin_i = std::sin(i), cos_i = std::cos(i), sin_n = std::sin(node), cos_n = std::cos(node);
  OrbitPoint out;
  out.p = {x * cos_n - y * cos_i * sin_n, x * sin_n + y * cos_i * cos_n, y * sin_i};
  out.v = {x_dot * cos_n - y_dot * cos_i * sin_n + y * sin_i * sin_n * i_dot - out.p.y() * node_dot,
           x_dot * sin_n + y_dot * cos_i * cos_n - y * sin_i * cos_n * i_dot + out.p.x() * node_dot,
           y_dot * sin_i + y * cos_i * i_dot};
  return out;
}

/// From the inclined frame of a D2 message, which does not turn with the Earth, to E: Rz(w tk) Rx(-5 deg).
OrbitPoint from_geostationary_frame(const OrbitPoint& g, double earth_rate_rad_s, double tk_s) {
  const double c5 = std::cos(-5.0 * kDegree), s5 = std::sin(-5.0 * kDegree);
  const double c = std::cos(earth_rate_rad_s * tk_s), s = std::sin(earth_rate_rad_s * tk_s);
  const auto turned = [&](const Eigen::Vector3d& a) {
    const Eigen::Vector3d b(a.x(), c5 * a.y() + s5 * a.z(), -s5 * a.y() + c5 * a.z());
    return Eigen::Vector3d(c * b.x() + s * b.y(), -s * b.x() + c * b.y(), b.z());
  };
  OrbitPoint out{turned(g.p), turned(g.v)};
  out.v += earth_rate_rad_s * Eigen::Vector3d(out.p.y(), -out.p.x(), 0.0);
  return out;
}

}  // namespace

bool KeplerEphemeris::healthy() const {
  if (sv.system == GnssSystem::kQzss && message == Message::kLnav) return (health & ~1) == 0;
  if (message == Message::kCnav || message == Message::kCnav2) return (health & ~1) == 0;
  if (sv.system == GnssSystem::kGalileo && accuracy_m < 0.0) return false;
  return health == 0;
}

bool KeplerEphemeris::valid_at(GpsTime t) const {
  const double tk_s = t - toe;
  return tk_s >= -valid_before_s && tk_s <= valid_after_s;
}

bool KeplerEphemeris::geostationary_frame() const {
  return message == Message::kD2;
}

std::array<double, 10> KeplerEphemeris::group_delay_s() const {
  std::array<double, 10> out{};
  switch (message) {
    case Message::kLnav:  // IS-GPS-200N 20.3.3.3.3.2
      out[1] = tgd_s;
      out[2] = tgd_s * squared_ratio(sv.system, 2);
      break;
    case Message::kCnav:
    case Message::kCnav2:  // IS-GPS-200N 30.3.3.3.1.1
      for (const std::size_t band : {1u, 2u, 5u}) out[band] = tgd_s - isc_s[band];
      break;
    case Message::kInav:  // OS SIS ICD 2.1, 5.1.5; E5a through E1, on which both messages agree
      out[1] = tgd2_s;
      out[7] = tgd2_s * squared_ratio(sv.system, 7);
      out[5] = tgd2_s + tgd_s * (squared_ratio(sv.system, 5) - 1.0);
      break;
    case Message::kFnav:
      out[1] = tgd_s;
      out[5] = tgd_s * squared_ratio(sv.system, 5);
      break;
    case Message::kD1:
    case Message::kD2:  // BDS-SIS-ICD-B1I 3.0, 5.2.4.10: the clock is that of B3I, band 6
      out[1] = out[2] = tgd_s;
      out[7] = tgd2_s;
      break;
    case Message::kBcnav1:
    case Message::kBcnav2:  // BDS-SIS-ICD-B1C 1.0, 7.6.2: pilot components; the data components add their ISC
      out[1] = out[2] = tgd_s;
      out[5] = tgd2_s;
      break;
    case Message::kFdma:
    case Message::kAlmanac:
      break;
  }
  return out;
}

unsigned KeplerEphemeris::borrowed_delay_bands() const {
  if (message == Message::kD1 || message == Message::kD2) return 1u << 1;
  if (message == Message::kBcnav1 || message == Message::kBcnav2) return 1u << 2;
  return 0;
}

SatelliteState KeplerEphemeris::at(GpsTime t) const {
  const SystemConstants& k = constants_of(sv.system);
  const double tk_s = t - toe;
  const double a0_m = sqrt_a * sqrt_a, a_m = a0_m + a_dot_m_s * tk_s;
  const double n_rad_s = std::sqrt(k.mu_m3_s2 / (a0_m * a0_m * a0_m)) + delta_n_rad_s + 0.5 * delta_n_dot_rad_s2 * tk_s;
  const double E = eccentric_anomaly(m0_rad + n_rad_s * tk_s, e);
  const double sin_E = std::sin(E), cos_E = std::cos(E);
  const double E_dot = (n_rad_s + 0.5 * delta_n_dot_rad_s2 * tk_s) / (1.0 - e * cos_E);

  const double root = std::sqrt(1.0 - e * e);
  const double phi = std::atan2(root * sin_E, cos_E - e) + argument_of_perigee_rad;
  const double phi_dot = root * E_dot / (1.0 - e * cos_E);
  const double s2 = std::sin(2.0 * phi), c2 = std::cos(2.0 * phi);

  const double u = phi + cus_rad * s2 + cuc_rad * c2;
  const double u_dot = phi_dot * (1.0 + 2.0 * (cus_rad * c2 - cuc_rad * s2));
  const double r = a_m * (1.0 - e * cos_E) + crs_m * s2 + crc_m * c2;
  const double r_dot =
      a_dot_m_s * (1.0 - e * cos_E) + a_m * e * sin_E * E_dot + 2.0 * phi_dot * (crs_m * c2 - crc_m * s2);
  const double i = i0_rad + idot_rad_s * tk_s + cis_rad * s2 + cic_rad * c2;
  const double i_dot = idot_rad_s + 2.0 * phi_dot * (cis_rad * c2 - cic_rad * s2);
  const double node_dot = omega_dot_rad_s - (geostationary_frame() ? 0.0 : k.earth_rate_rad_s);
  const double toe_sow_s = (toe - k.ahead_s).sow_s();  // of the system's own week
  const double node = omega0_rad + node_dot * tk_s - k.earth_rate_rad_s * toe_sow_s;

  const double x = r * std::cos(u), y = r * std::sin(u);  // in the orbital plane
  const double x_dot = r_dot * std::cos(u) - y * u_dot, y_dot = r_dot * std::sin(u) + x * u_dot;
  OrbitPoint point = turned_about_node(x, y, x_dot, y_dot, node, node_dot, i, i_dot);
  if (geostationary_frame()) point = from_geostationary_frame(point, k.earth_rate_rad_s, tk_s);

  SatelliteState s;
  s.p_E = point.p;
  s.v_E = point.v;
  const double tc_s = t - toc;
  const double relativity = k.relativity_s_per_sqrt_m * e * sqrt_a;
  s.clock_s = af0_s + af1 * tc_s + af2_per_s * tc_s * tc_s + relativity * sin_E;
  s.clock_rate = af1 + 2.0 * af2_per_s * tc_s + relativity * cos_E * E_dot;
  s.group_delay_s = group_delay_s();
  s.borrowed_delay_bands = borrowed_delay_bands();
  s.accuracy_m = accuracy_m;
  return s;
}

Validity default_validity(GnssSystem system, NavigationMessage message) {
  constexpr double kHourS = 3600.0;
  switch (system) {
    case GnssSystem::kGalileo:
      return {1.0 * kHourS, 4.0 * kHourS};
    case GnssSystem::kBeidou:
      return {1.0 * kHourS, 2.0 * kHourS};
    case GnssSystem::kQzss:
      return {1.0 * kHourS, 1.0 * kHourS};
    default:
      break;
  }
  if (message == Message::kLnav) return {2.0 * kHourS, 2.0 * kHourS};
  return {1.5 * kHourS, 1.5 * kHourS};
}

}  // namespace canyon::gnss
