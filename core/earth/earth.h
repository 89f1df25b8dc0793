#pragma once

#include <Eigen/Core>

namespace canyon {

/// WGS84 (NIMA TR8350.2) constants.
struct Wgs84 {
  static constexpr double a_m = 6378137.0;
  static constexpr double f = 1.0 / 298.257223563;
  static constexpr double e2 = f * (2.0 - f);
  static constexpr double gm_m3_s2 = 3.986004418e14;
  static constexpr double rate_rad_s = 7.292115e-5;
};

/// Earth rotation rate used by inertial generator and filter alike, w_IE_E = (0, 0, rate).
inline Eigen::Vector3d earth_rate_E() {
  return {0.0, 0.0, Wgs84::rate_rad_s};
}

struct Geodetic {
  double lat_rad = 0.0;
  double lon_rad = 0.0;
  double h_m = 0.0;  ///< above the WGS84 ellipsoid
};

Eigen::Vector3d ecef_from_geodetic(const Geodetic& g);
/// Valid everywhere, including the poles and the Earth's centre (GeographicLib::Geocentric).
Geodetic geodetic_from_ecef(const Eigen::Vector3d& p_E);

/// Rotation from local east-north-up at a geodetic point to E.
Eigen::Matrix3d rotation_E_from_enu(const Geodetic& g);

/// WGS84 normal gravity (gravitation plus centrifugal), m/s^2, in E, at p_E. Closed form, not a series in height.
Eigen::Vector3d gravity_E(const Eigen::Vector3d& p_E);
/// Gradient of gravity_E by central differences, 1/s^2; for the filter's propagation.
Eigen::Matrix3d gravity_gradient_E(const Eigen::Vector3d& p_E);

}  // namespace canyon
