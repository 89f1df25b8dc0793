#include "canyon/gnss/satellites/ephemerides/glonass_ephemeris.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/gnss/satellites/system_constants.h"

namespace canyon::gnss {
namespace {

constexpr double kJ2 = 1082625.75e-9;          // ICD table 3.2, second zonal harmonic
constexpr double kEquatorRadiusM = 6378136.0;  // the same, PZ-90
constexpr double kRungeKuttaStepS = 60.0;

struct Motion {
  Eigen::Vector3d p_E, v_E;
};

Motion derivative(const Motion& m, const Eigen::Vector3d& a_E) {
  const SystemConstants& k = constants_of(GnssSystem::kGlonass);
  const double w = k.earth_rate_rad_s;
  const double r2 = m.p_E.squaredNorm(), r = std::sqrt(r2);
  const double central = k.mu_m3_s2 / (r2 * r);
  const double j2 = 1.5 * kJ2 * central * kEquatorRadiusM * kEquatorRadiusM / r2;
  const double z2 = 5.0 * m.p_E.z() * m.p_E.z() / r2;
  const double horizontal = -central - j2 * (1.0 - z2) + w * w;
  return {m.v_E,
          {horizontal * m.p_E.x() + 2.0 * w * m.v_E.y() + a_E.x(),
           horizontal * m.p_E.y() - 2.0 * w * m.v_E.x() + a_E.y(), (-central - j2 * (3.0 - z2)) * m.p_E.z() + a_E.z()}};
}

Motion stepped(const Motion& m, const Motion& rate, double h_s) {
  return {m.p_E + h_s * rate.p_E, m.v_E + h_s * rate.v_E};
}

Motion runge_kutta(const Motion& m, const Eigen::Vector3d& a_E, double h_s) {
  const Motion k1 = derivative(m, a_E), k2 = derivative(stepped(m, k1, 0.5 * h_s), a_E),
               k3 = derivative(stepped(m, k2, 0.5 * h_s), a_E), k4 = derivative(stepped(m, k3, h_s), a_E);
  return {m.p_E + h_s / 6.0 * (k1.p_E + 2.0 * k2.p_E + 2.0 * k3.p_E + k4.p_E),
          m.v_E + h_s / 6.0 * (k1.v_E + 2.0 * k2.v_E + 2.0 * k3.v_E + k4.v_E)};
}

}  // namespace

bool GlonassEphemeris::valid_at(GpsTime t) const {
  return std::abs(t - toe) <= kValidS;
}

SatelliteState GlonassEphemeris::at(GpsTime t) const {
  const double tk_s = t - toe;
  CANYON_CHECK(std::abs(tk_s) <= 86400.0, sv.str(), " at ", tk_s, " s from its ephemeris");
  Motion m{p_E, v_E};
  double rest_s = std::abs(tk_s);
  const double sign = tk_s < 0.0 ? -1.0 : 1.0;
  for (; rest_s > kRungeKuttaStepS; rest_s -= kRungeKuttaStepS) m = runge_kutta(m, a_E, sign * kRungeKuttaStepS);
  m = runge_kutta(m, a_E, sign * rest_s);

  SatelliteState s;
  s.p_E = m.p_E;
  s.v_E = m.v_E;
  s.clock_s = clock_s + clock_rate * tk_s;
  s.clock_rate = clock_rate;
  s.group_delay_s[2] = delta_tau_s;
  s.frequency_channel = frequency_channel;
  return s;
}

}  // namespace canyon::gnss
