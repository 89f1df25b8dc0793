#pragma once

#include "canyon/fusion/measurements/measurement.h"

namespace canyon::fusion {

/// Velocity over ground of a point fixed to B, in B's axes, and how it depends on the errors.
struct BodyVelocity {
  Eigen::Vector3d v_B;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor, 3, kMostStates> H;
};

/// Of the point at `p_B` from B's origin, m.
BodyVelocity body_velocity(const FilterView& filter, const Eigen::Vector3d& p_B);

}  // namespace canyon::fusion
