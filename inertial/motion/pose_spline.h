#pragma once

#include <optional>
#include <vector>

#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/motion/quintic_spline.h"

namespace canyon::inertial {

/// Points a body is to pass, at increasing times from the start. Without attitudes the nose points along the track.
struct PoseKnots {
  std::vector<double> t_s;
  std::vector<Eigen::Vector3d> p_WB;
  std::vector<Eigen::Quaterniond> R_WB;  ///< empty, or as many
};

/// Position and attitude four times continuously differentiable: a quintic spline of the coordinates, and one of the
/// four parts of the quaternion (each with the sign nearer to the one before), normalized. `smoothing_s` as in
/// QuinticSpline. An Error (without a place) says what cannot be joined: fewer than three points, attitudes more than
/// 120 degrees from one point to the next, or no direction of travel where attitudes are missing.
Result<std::shared_ptr<const Motion>> make_pose_spline(const PoseKnots& knots, double smoothing_s);

}  // namespace canyon::inertial
