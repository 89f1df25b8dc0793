#include "canyon/gnss/satellites/sun.h"

#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {

Eigen::Vector3d sun_direction_E(GpsTime t) {
  static const GpsTime j2000 = GpsTime::from_calendar(2000, 1, 1, 12, 0, 0.0);
  const double days = (static_cast<double>((t.ns - j2000.ns) / 1000) * 1e-6 - t.leap_seconds()) / 86400.0;  // of UT
  const double mean_longitude = (280.460 + 0.9856474 * days) * kDegree;
  const double anomaly = (357.528 + 0.9856003 * days) * kDegree;
  const double longitude = mean_longitude + (1.915 * std::sin(anomaly) + 0.020 * std::sin(2.0 * anomaly)) * kDegree;
  const double obliquity = (23.439 - 4e-7 * days) * kDegree;
  const double sidereal = std::fmod(280.46061837 + 360.98564736629 * days, 360.0) * kDegree;  // IAU 1982, linear part
  const double x = std::cos(longitude), y = std::cos(obliquity) * std::sin(longitude),
               z = std::sin(obliquity) * std::sin(longitude);
  const double c = std::cos(sidereal), s = std::sin(sidereal);
  return {c * x + s * y, -s * x + c * y, z};
}

}  // namespace canyon::gnss
