#include "canyon/core/motion/rotation.h"

#include <cmath>

#include "canyon/core/units.h"

namespace canyon {
namespace {

/// Below this angle series are used, whose first term left out is below 1e-16 of the sum.
constexpr double kSmallAngleRad = 0.1, kSmallAngle2 = kSmallAngleRad * kSmallAngleRad;
/// The same of series that are cut after their second term.
constexpr double kTinyAngleRad = 1e-4;

/// (a - sin a) / a^3 and cos a of q = a^2, which is at most kSmallAngle2.
double small_sine_defect(double q) {
  return 1.0 / 6.0 + q * (-1.0 / 120.0 + q * (1.0 / 5040.0 + q * (-1.0 / 362880.0 + q * (1.0 / 39916800.0))));
}
double small_cosine(double q) {
  return 1.0 + q * (-1.0 / 2.0 + q * (1.0 / 24.0 + q * (-1.0 / 720.0 + q * (1.0 / 40320.0 + q * (-1.0 / 3628800.0)))));
}
/// sin a / a
double small_sinc(double q) {
  return 1.0 - q * small_sine_defect(q);
}

/// Left Jacobian of SO(3), the V of SE(3): the translation of Exp(xi) is V(rotation) * translation.
Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& v) {
  return so3_right_jacobian(-v);
}

Eigen::Matrix3d so3_left_jacobian_inverse(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  double square_factor = 1.0 / 12.0 + angle * angle / 720.0;
  if (angle >= kTinyAngleRad) {
    // (1 - (a/2) cot(a/2)) / a^2, which stays finite at a = pi.
    const double half = 0.5 * angle;
    square_factor = (1.0 - half * std::cos(half) / std::sin(half)) / (angle * angle);
  }
  const Eigen::Matrix3d V = skew(v);
  return Eigen::Matrix3d::Identity() - 0.5 * V + square_factor * V * V;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& rotation_vector) {
  const double angle2 = rotation_vector.squaredNorm();
  double w = 0.0, factor = 0.0;
  if (angle2 < kSmallAngle2) {
    w = small_cosine(0.25 * angle2);
    factor = 0.5 * small_sinc(0.25 * angle2);
  } else {
    const double angle = rotation_vector.norm();
    w = std::cos(0.5 * angle);
    factor = std::sin(0.5 * angle) / angle;
  }
  return {w, factor * rotation_vector.x(), factor * rotation_vector.y(), factor * rotation_vector.z()};
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& q) {
  const double n = q.vec().norm();
  // q and -q are the same rotation: the one with w >= 0 has the angle in [0, pi].
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double w = std::abs(q.w());
  if (n < 0.5 * kTinyAngleRad * w) {
    const double ratio = n / w;
    return (sign * 2.0 / w) * (1.0 - ratio * ratio / 3.0) * q.vec();
  }
  return (sign * 2.0 * std::atan2(n, w) / n) * q.vec();
}

Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& v) {
  // (1 - cos a) / a^2 = half_sine^2 / 2 without cancellation, and (a - sin a) / a^3, which cancels at small angles.
  const double angle2 = v.squaredNorm();
  double half_sine = 0.0, square = 0.0;
  if (angle2 < kSmallAngle2) {
    half_sine = small_sinc(0.25 * angle2);
    square = small_sine_defect(angle2);
  } else {
    const double angle = v.norm();
    half_sine = std::sin(0.5 * angle) / (0.5 * angle);
    square = (angle - std::sin(angle)) / (angle * angle2);
  }
  const Eigen::Matrix3d V = skew(v);
  return Eigen::Matrix3d::Identity() - 0.5 * half_sine * half_sine * V + square * V * V;
}

YawPitchRoll yaw_pitch_roll(const Eigen::Quaterniond& R_WB) {
  const Eigen::Matrix3d R = R_WB.toRotationMatrix();
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(-R(2, 0), cos_pitch);
  // Looking straight up or down only yaw -+ roll is defined; all of it is given to yaw.
  if (cos_pitch < 1e-15) return {std::atan2(-R(0, 1), R(1, 1)), pitch, 0.0};
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  if (cos_pitch > 0.5) return {yaw, pitch, std::atan2(R(2, 1), R(2, 2))};
  // Near the vertical yaw is uncertain by eps / cos(pitch). Roll is what is left once that yaw is taken off, so that
  // the two make the attitude again.
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {yaw, pitch, std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1))};
}

Eigen::Quaterniond rotation_from(const YawPitchRoll& angles) {
  return Eigen::AngleAxisd(angles.yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.roll_rad, Eigen::Vector3d::UnitX());
}

double heading_from_yaw(double yaw_rad) {
  const double heading = wrap_pi(0.5 * kPi - yaw_rad);
  if (heading >= 0.0) return heading;
  // A tiny negative angle plus 2 pi rounds to 2 pi itself, which is outside [0, 2 pi).
  const double turned = heading + 2.0 * kPi;
  return turned < 2.0 * kPi ? turned : 0.0;
}

double yaw_from_heading(double heading_rad) {
  return wrap_pi(0.5 * kPi - heading_rad);
}

double wrap_pi(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

Pose Pose::inverse() const {
  return {R.conjugate(), -(R.conjugate() * p)};
}

Pose Pose::operator*(const Pose& o) const {
  return {(R * o.R).normalized(), R * o.p + p};
}

Eigen::Vector3d Pose::operator*(const Eigen::Vector3d& p_B) const {
  return R * p_B + p;
}

Pose Pose::exp(const Vector6d& xi) {
  const Eigen::Vector3d rotation = xi.head<3>();
  return {so3_exp(rotation), so3_left_jacobian(rotation) * xi.tail<3>()};
}

Vector6d Pose::log() const {
  const Eigen::Vector3d rotation = so3_log(R);
  Vector6d xi;
  xi << rotation, so3_left_jacobian_inverse(rotation) * p;
  return xi;
}

Eigen::Matrix4d Pose::matrix() const {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = R.toRotationMatrix();
  T.topRightCorner<3, 1>() = p;
  return T;
}

Pose Pose::from_matrix(const Eigen::Matrix4d& T) {
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  return {Eigen::Quaterniond(R).normalized(), T.topRightCorner<3, 1>()};
}

Pose interpolate(const Pose& a, const Pose& b, double s) {
  if (s == 0.0) return a;
  if (s == 1.0) return b;
  return a * Pose::exp(s * (a.inverse() * b).log());
}

}  // namespace canyon
