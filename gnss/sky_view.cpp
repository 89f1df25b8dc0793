#include "canyon/gnss/sky_view.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {

Horizon::Horizon(const Eigen::Vector3d& p_E)
    : p_E_(p_E), geodetic_(geodetic_from_ecef(p_E)), R_E_enu_(rotation_E_from_enu(geodetic_)) {}

SkyView Horizon::view(GpsTime t, const Eigen::Vector3d& satellite_E) const {
  const Eigen::Vector3d enu = R_E_enu_.transpose() * (satellite_E - p_E_).normalized();
  double azimuth_rad = std::atan2(enu.x(), enu.y());
  if (azimuth_rad < 0.0) azimuth_rad += 2.0 * kPi;
  if (azimuth_rad >= 2.0 * kPi) azimuth_rad = 0.0;  // a rounding west of north
  return {t, geodetic_, std::asin(std::clamp(enu.z(), -1.0, 1.0)), azimuth_rad};
}

}  // namespace canyon::gnss
