#include "canyon/core/earth/earth.h"

#include <cmath>

#include <GeographicLib/Geocentric.hpp>

#include "canyon/core/units.h"

namespace canyon {

Eigen::Vector3d ecef_from_geodetic(const Geodetic& g) {
  Eigen::Vector3d p_E;
  GeographicLib::Geocentric::WGS84().Forward(g.lat_rad / kDegree, g.lon_rad / kDegree, g.h_m, p_E.x(), p_E.y(),
                                             p_E.z());
  return p_E;
}

Geodetic geodetic_from_ecef(const Eigen::Vector3d& p_E) {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double h_m = 0.0;
  GeographicLib::Geocentric::WGS84().Reverse(p_E.x(), p_E.y(), p_E.z(), lat_deg, lon_deg, h_m);
  return {lat_deg * kDegree, lon_deg * kDegree, h_m};
}

Eigen::Matrix3d rotation_E_from_enu(const Geodetic& g) {
  const double sin_lat = std::sin(g.lat_rad);
  const double cos_lat = std::cos(g.lat_rad);
  const double sin_lon = std::sin(g.lon_rad);
  const double cos_lon = std::cos(g.lon_rad);
  Eigen::Matrix3d R;
  R.col(0) << -sin_lon, cos_lon, 0.0;
  R.col(1) << -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat;
  R.col(2) << cos_lat * cos_lon, cos_lat * sin_lon, sin_lat;
  return R;
}

}  // namespace canyon
