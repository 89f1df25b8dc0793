#pragma once

#include "canyon/tests/lidar/registration/trials/trial.h"

namespace canyon::lidar::trials {

inline constexpr double kWrong_m = 0.2;
inline constexpr double kWrong_deg = 0.5;

/// A result beside the truth. Errors are in the directions that the result calls closed; along the others it says no
/// more than the prior.
struct Verdict {
  bool converged = false;
  Vector6d error = Vector6d::Constant(kNaN), sigma = Vector6d::Constant(kNaN);  ///< xi, in all directions
  double error_m = kNaN, error_deg = kNaN;
  bool right = false;      ///< within kWrong_m and kWrong_deg
  bool inside = false;     ///< of its own 99.9 % ellipsoid, all six directions
  bool undecided = false;  ///< it calls itself ambiguous, or directions open
  double nees = kNaN;      ///< of the closed directions
  int closed = 0;
  bool within_95 = false;
  double widest_3_sigma_m = kNaN;  ///< of the closed directions' shifts
  bool silent() const { return converged && !(right && inside); }
};

/// `radius_m`: rms distance of the source's points, at which rotations count.
Verdict judge(const Trial& trial, const RegistrationResult& result, double radius_m);

/// Whether a pose without a covariance is right, in the directions that the place determines.
bool right_where_determined(const Trial& trial, const Pose& X_TS, double radius_m);

double rms_radius(std::span<const Eigen::Vector3f> points);

}  // namespace canyon::lidar::trials
