#include "canyon/gnss/atmosphere/klobuchar.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {

double klobuchar_obliquity(double elevation_rad) {
  const double x = 0.53 - elevation_rad / kPi;
  return 1.0 + 16.0 * x * x * x;
}

double klobuchar_delay_m(const KlobucharCoefficients& c, GpsTime t, double lat_rad, double lon_rad, double azimuth_rad,
                         double elevation_rad) {
  // Semicircles throughout, as in the specification.
  const double E = elevation_rad / kPi;
  const double psi = 0.0137 / (E + 0.11) - 0.022;
  const double phi_i = std::clamp(lat_rad / kPi + psi * std::cos(azimuth_rad), -0.416, 0.416);
  const double lambda_i = lon_rad / kPi + psi * std::sin(azimuth_rad) / std::cos(phi_i * kPi);
  const double phi_m = phi_i + 0.064 * std::cos((lambda_i - 1.617) * kPi);

  double local_s = std::fmod(4.32e4 * lambda_i + t.sow_s(), 86400.0);
  if (local_s < 0.0) local_s += 86400.0;

  const auto cubic = [phi_m](const std::array<double, 4>& k) {
    return k[0] + phi_m * (k[1] + phi_m * (k[2] + phi_m * k[3]));
  };
  const double amplitude_s = std::max(cubic(c.alpha), 0.0);
  const double period_s = std::max(cubic(c.beta), 72000.0);
  const double x = 2.0 * kPi * (local_s - 50400.0) / period_s;
  const double zenith_s = std::abs(x) < 1.57 ? 5e-9 + amplitude_s * (1.0 - x * x / 2.0 + x * x * x * x / 24.0) : 5e-9;
  return kSpeedOfLight * klobuchar_obliquity(elevation_rad) * zenith_s;
}

}  // namespace canyon::gnss
