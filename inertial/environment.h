#pragma once

#include <vector>

#include <Eigen/Core>

namespace canyon::inertial {

/// What acts on a unit beside the motion.
struct Environment {
  /// Temperature of the unit over time since the first sample: corners of a piecewise linear profile, constant outside.
  /// Times increase. Empty: the unit is at the temperature that its figures hold for.
  std::vector<double> temperature_times_s;
  std::vector<double> temperatures_c;
  /// Root mean square of the vibration that is too fast to be in the samples, per axis of U, m/s^2.
  Eigen::Vector3d vibration_rms_m_s2 = Eigen::Vector3d::Zero();
};

}  // namespace canyon::inertial
