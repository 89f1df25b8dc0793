#pragma once

#include <Eigen/Core>

#include "canyon/core/time.h"

namespace canyon::gnss {

/// Direction to the Sun from the Earth's centre, unit vector in E. Low-precision formula of the Astronomical Almanac:
/// good to 0.01 deg from 1950 to 2050; UT1 is taken as UTC.
Eigen::Vector3d sun_direction_E(GpsTime t);

}  // namespace canyon::gnss
