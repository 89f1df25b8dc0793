#pragma once

#include "canyon/fusion/measurements/measurement.h"

namespace canyon::fusion {

using BodyRows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor, 3, kMostStates>;

/// Velocity over ground of a point fixed to B, in B's axes (m/s), and how it depends on the errors.
struct BodyVelocity {
  Eigen::Vector3d v_B;
  BodyRows H;
};
/// Of the point at `p_B` from B's origin, m.
BodyVelocity body_velocity(const FilterView& filter, const Eigen::Vector3d& p_B);

/// Velocity of the same point in E.
struct PointVelocity {
  Eigen::Vector3d v_E;
  BodyRows H;
};
PointVelocity point_velocity(const FilterView& filter, const Eigen::Vector3d& p_B);

/// Place of the same point in E, m.
struct PointPlace {
  Eigen::Vector3d p_E;
  BodyRows H;
};
PointPlace point_place(const FilterView& filter, const Eigen::Vector3d& p_B);

/// Place and velocity of the antenna, the error of its lever arm as the block antenna_lever has it included.
PointPlace antenna_place(const FilterView& filter);
PointVelocity antenna_velocity(const FilterView& filter);

/// The axes of B in E, and the rotation vector in B by which the errors turn them, rad.
struct BodyAttitude {
  Eigen::Matrix3d R_EB;
  BodyRows H;
};
BodyAttitude body_attitude(const FilterView& filter);

/// Rate at which the velocity of any point changes in B's axes, m/s^2, while the unit turns evenly:
///   f + g - 2 w_IE x v - w_EU x v, all in U.
struct BodyAcceleration {
  Eigen::Vector3d a_B;
  BodyRows H;
};
BodyAcceleration body_acceleration(const FilterView& filter);

/// Acceleration of the IMU over ground in E, m/s^2: R f + g - 2 w_IE x v.
struct PointAcceleration {
  Eigen::Vector3d a_E;
  BodyRows H;
};
PointAcceleration acceleration(const FilterView& filter);

}  // namespace canyon::fusion
