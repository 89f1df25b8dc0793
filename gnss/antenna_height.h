#pragma once

#include <Eigen/Core>

#include "canyon/core/result.h"

namespace canyon::gnss {

/// Ellipsoidal heights of an antenna that the models cover, m: those of the standard atmosphere, which the tropospheric
/// delay and its height correction stand on (atmosphere/weather.h). All land lies above the lower one; above the upper
/// one the ionosphere begins to be beside the receiver and not over it.
inline constexpr double kLowestAntennaM = -500.0, kHighestAntennaM = 20000.0;

bool is_covered_height(double h_m);
/// An Error where a height, or that of p_E, is not covered; `where` says in whose words: its file, line and key.
Status check_antenna_height(double h_m, Error where);
Status check_antenna_height(const Eigen::Vector3d& p_E, Error where);

}  // namespace canyon::gnss
