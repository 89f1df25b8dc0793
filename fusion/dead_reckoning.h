#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
#include "canyon/core/messages.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// States at the start and after every sample, by free inertial navigation from `initial`. Samples that end at or
/// before initial.t only let the integrator look back; of one whose interval holds initial.t, the part after it is
/// taken as its share of the time. Where samples are missing between two (a gap of more than half an interval) the
/// integrator forgets its past and the one after the gap stands for it: its mean rates are taken for the whole time.
/// A sample that is not finite or not later than the one before it is refused with a ProgramError.
std::vector<NavState> dead_reckon(std::span<const ImuSample> samples, const NavState& initial, Strapdown& strapdown);

/// A state at rest at that place and heading, its attitude levelled with a specific force (of any length) measured
/// there, which stands against WGS84 normal gravity. `t` is left 0.
NavState levelled(const Geodetic& at, double heading_rad, const Eigen::Vector3d& force_U);

/// State at t, between two states: position cubic (it has their velocities), velocity linear, attitude on the geodesic.
NavState interpolate(const NavState& a, const NavState& b, GpsTime t);

/// How far an estimate is from a reference, estimate minus reference, at one instant.
struct NavError {
  GpsTime t;
  Eigen::Vector3d position_enu_m, velocity_enu_m_s;
  Eigen::Vector3d attitude_rad;  ///< rotation vector in the reference's body: about x (roll), y (pitch), z (yaw)
};

/// At every reference state within the time of the estimate, which is interpolated there. Both in order of time. A
/// reference without velocity (NaN) leaves the velocity error NaN.
std::vector<NavError> navigation_errors(std::span<const NavState> estimate, std::span<const NavState> reference);

/// Root mean squares over the errors after the first, which is that of the start; NaN where there is none.
struct NavErrorStatistics {
  Eigen::Vector3d position_rms_enu_m, velocity_rms_enu_m_s, attitude_rms_rad;
  double position_rms_m = kNaN, final_error_m = kNaN, final_horizontal_m = kNaN;
};
NavErrorStatistics navigation_error_statistics(std::span<const NavError> errors);

}  // namespace canyon::fusion
