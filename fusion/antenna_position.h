#pragma once

#include <Eigen/Core>

#include "canyon/fusion/error_state.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// Where the filter expects the antenna, and how that depends on its errors.
struct AntennaPosition {
  Eigen::Vector3d p_A_E;
  /// d p_A_E / d [theta, p, v] (the other states do not enter), m per rad, 1, s. The errors are truth minus estimate.
  Eigen::Matrix<double, 3, 9> H;
};

/// Antenna at `arm_U` from the IMU (in U, m), at `age_s` seconds after the state (carried there with its velocity and
/// rate `w_EU_U`):
///   p_A = p + R arm + age (v + R (w x arm)).
AntennaPosition antenna_position(const NavState& state, const Eigen::Vector3d& w_EU_U, const Eigen::Vector3d& arm_U,
                                 double age_s);

}  // namespace canyon::fusion
