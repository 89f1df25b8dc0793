#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace canyon {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// SO(3) exponential of a rotation vector, rad; a series below 0.1 rad, to the last digit as elsewhere.
Eigen::Quaterniond so3_exp(const Eigen::Vector3d& rotation_vector);
/// Inverse of so3_exp, |result| <= pi.
Eigen::Vector3d so3_log(const Eigen::Quaterniond& q);
/// Right Jacobian of SO(3): Exp(v + d) = Exp(v) Exp(Jr(v) d) to first order.
Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& v);

/// Yaw (from east, counter-clockwise), pitch (nose down positive about y-left), roll of R_WB, rad; R = Rz(yaw)
/// Ry(pitch) Rx(roll).
struct YawPitchRoll {
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
};
YawPitchRoll yaw_pitch_roll(const Eigen::Quaterniond& R_WB);
Eigen::Quaterniond rotation_from(const YawPitchRoll& angles);

/// Heading (from true north, clockwise, [0, 2 pi)) of a yaw (from east, counter-clockwise) and back.
double heading_from_yaw(double yaw_rad);
double yaw_from_heading(double heading_rad);
/// Angle wrapped to (-pi, pi].
double wrap_pi(double angle_rad);

/// Rigid transform X_AB: a point of B expressed in A is p_A = R * p_B + p.
/// Errors are right perturbations X = X_hat * Exp(xi), xi = [rotation; translation] in the source frame B.
struct Pose {
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();

  static Pose exp(const Vector6d& xi);
  Vector6d log() const;
  Pose inverse() const;
  Pose operator*(const Pose& o) const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& p_B) const;
  Eigen::Matrix4d matrix() const;
  static Pose from_matrix(const Eigen::Matrix4d& T);
};

/// Pose on the SE(3) geodesic from a (s = 0) to b (s = 1).
Pose interpolate(const Pose& a, const Pose& b, double s);

}  // namespace canyon
