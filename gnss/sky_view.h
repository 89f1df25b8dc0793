#pragma once

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
#include "canyon/core/time.h"

namespace canyon::gnss {

/// A satellite as seen from a receiver; what the atmosphere models need.
struct SkyView {
  GpsTime t;
  Geodetic receiver;
  double elevation_rad = 0.0;  ///< above the ellipsoid's tangent plane at the receiver
  double azimuth_rad = 0.0;    ///< from true north, clockwise, [0, 2 pi)
};

/// The local horizon of a receiver at p_E.
class Horizon {
 public:
  explicit Horizon(const Eigen::Vector3d& p_E);

  const Geodetic& geodetic() const { return geodetic_; }
  const Eigen::Matrix3d& R_E_enu() const { return R_E_enu_; }
  SkyView view(GpsTime t, const Eigen::Vector3d& satellite_E) const;

 private:
  Eigen::Vector3d p_E_;
  Geodetic geodetic_;
  Eigen::Matrix3d R_E_enu_;
};

}  // namespace canyon::gnss
