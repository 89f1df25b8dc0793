#pragma once

#include <cmath>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/solver/position_solver.h"

namespace canyon::gnss {

struct Sky {
  double azimuth_deg, elevation_deg;
};

/// Ranges from p_E to satellites in those directions, light time and the Earth's turn included.
inline std::vector<RangeMeasurement> ranges_from(const Eigen::Vector3d& p_E, const std::vector<Sky>& sky,
                                                 double clock_m) {
  const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(p_E));
  std::vector<RangeMeasurement> out;
  for (const Sky& s : sky) {
    const double a = s.azimuth_deg * kDegree, e = s.elevation_deg * kDegree;
    const Eigen::Vector3d line = R * Eigen::Vector3d(std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e));
    const double range_m = 22e6 + 3e6 * std::cos(e);
    const Eigen::Vector3d at_reception = p_E + range_m * line;
    out.push_back({turned_by_earth(at_reception, -range_m / kSpeedOfLight), range_m + clock_m, 1.0});
  }
  return out;
}

inline const Eigen::Vector3d kVicksburg = ecef_from_geodetic({32.35 * kDegree, -90.88 * kDegree, 60.0});

}  // namespace canyon::gnss
