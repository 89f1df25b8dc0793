#include "canyon/core/motion/rotation.h"

#include <vector>

#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Worst;

std::vector<Vector3d> axes() {
  return {Vector3d::UnitX(), -Vector3d::UnitZ(), Vector3d(1, 1, 1).normalized(), Vector3d(1e-8, -1, 1e-3).normalized(),
          Vector3d(0.6, 0.0, -0.8)};
}

/// exp then log. Each takes about ten roundings (norm, half angle, sine and cosine, quotient, products), all relative.
StressFigure there_and_back(const std::vector<double>& angles_rad) {
  Worst worst;
  for (const double angle : angles_rad)
    for (const Vector3d& axis : axes()) {
      const Vector3d v = angle * axis, back = so3_log(so3_exp(v));
      // At half a turn v and -v are the same rotation.
      const double miss = angle > 3.0 ? std::min((back - v).norm(), (back + v * (2.0 * kPi / v.norm() - 1.0)).norm())
                                      : (back - v).norm();
      worst.look(miss, 10.0 * kEpsilon * angle);
    }
  return worst.figure();
}

/// Jr = I - (1 - cos a) / a^2 [v] + (a - sin a) / a^3 [v]^2 with coefficients in 64 bits of mantissa, by series below
/// 0.1 rad. In the code the cancelling difference a - sin a costs eps / a^2 of a coefficient that a^2 multiplies: eps.
StressFigure right_jacobian() {
  Worst worst;
  for (double angle = 1e-12; angle < 2.0 * kPi; angle *= 1.37)
    for (const Vector3d& axis : axes()) {
      const long double a = angle, q = a * a;
      const bool series = angle < 0.1;
      const long double linear =
          series ? 0.5L - q / 24 + q * q / 720 - q * q * q / 40320 + q * q * q * q / 3628800 : (1 - std::cos(a)) / q;
      const long double square = series
                                     ? 1.0L / 6 - q / 120 + q * q / 5040 - q * q * q / 362880 + q * q * q * q / 39916800
                                     : (a - std::sin(a)) / (q * a);
      const Vector3d v = angle * axis;
      const Eigen::Matrix3d V = skew(v);
      const Eigen::Matrix3d exact =
          Eigen::Matrix3d::Identity() - static_cast<double>(linear) * V + static_cast<double>(square) * V * V;
      worst.look((so3_right_jacobian(v) - exact).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
                 10.0 * kEpsilon * std::max(1.0, angle));
    }
  return worst.figure();
}

/// Angles of an attitude that looks up or down to within `off_rad`, and the attitude that they make again. To the
/// angles some ten roundings of terms up to 1, back as many: 20 epsilons of attitude, wherever it looks.
StressFigure near_the_vertical(const std::vector<double>& off_rad) {
  Worst worst;
  for (const double sign : {-1.0, 1.0})
    for (const double off : off_rad)
      for (double yaw = -3.1; yaw < 3.2; yaw += 0.77)
        for (double roll = -3.0; roll < 3.2; roll += 0.91) {
          const Eigen::Quaterniond R = rotation_from({yaw, sign * (0.5 * kPi - off), roll});
          worst.look(so3_log(R.conjugate() * rotation_from(yaw_pitch_roll(R))).norm(), 20.0 * kEpsilon);
        }
  return worst.figure();
}

/// Angles at and beside multiples of half a turn. 2 pi is held to 2.4e-16, which counts once a turn.
StressFigure wrapped_angles() {
  Worst worst;
  for (const double turns : {0.0, 0.5, -0.5, 1.0, 1.5, -7.0, 1e3, -1e6, 1e9 + 0.5})
    for (const double beside : {-1e-3, -1e-15, 0.0, 1e-15, 1e-3}) {
      const double angle = turns * 2.0 * kPi + beside, wrapped = wrap_pi(angle);
      const double bound = kEpsilon * (2.0 + std::abs(angle));
      const bool inside = wrapped > -kPi && wrapped <= kPi;
      worst.look(inside ? std::hypot(std::sin(wrapped) - std::sin(angle), std::cos(wrapped) - std::cos(angle))
                        : stress::kInfinity,
                 bound);
      const double heading = heading_from_yaw(angle), yaw = yaw_from_heading(heading);
      worst.look(heading >= 0.0 && heading < 2.0 * kPi ? std::remainder(yaw - wrapped, 2.0 * kPi) : stress::kInfinity,
                 4.0 * kEpsilon * kPi + bound);
    }
  return worst.figure();
}

/// exp then log of a pose that turns by nearly half a turn and goes 10^7 m. V and its inverse have norms up to 1 and
/// pi / 2; each is a sum of three terms of products of two: 30 epsilons of the way.
StressFigure far_poses() {
  Worst worst;
  for (const double angle : {1e-12, 1e-5, 1e-4, 1.0, 3.0, kPi - 1e-6, kPi - 1e-12})
    for (const Vector3d& axis : axes()) {
      Vector6d xi;
      xi << angle * axis, 1e7 * Vector3d(0.3, -0.8, 0.5);
      const Vector6d back = Pose::exp(xi).log();
      worst.look((back - xi).tail<3>().norm(), 30.0 * kEpsilon * 1e7);
    }
  return worst.figure();
}

/// A full turn in a million equal parts, each product normalised: some four roundings of the quaternion a part, which
/// may all go the same way, turn it by 2 epsilons each at most.
StressFigure million_parts() {
  constexpr int kParts = 1'000'000;
  const Vector3d axis = Vector3d(2, -3, 6).normalized();
  const Eigen::Quaterniond part = so3_exp(axis * (2.0 * kPi / kParts));
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  for (int i = 0; i < kParts; ++i) R = (R * part).normalized();
  return {so3_log(R).norm(), 2.0 * kEpsilon * kParts};
}

}  // namespace

std::vector<StressCase> rotation_cases() {
  const auto group = StressGroup::kGeometry;
  const StressMechanism branch{
      group, "branch points of the rotation's logarithm",
      "0 / 0 at no turn; at half a turn acos loses eight digits and the sign of the axis is lost",
      "exp then log is the identity to 10 epsilons of the angle, from 1e-300 rad to half a turn: relative roundings",
      "of the bound"};
  const StressMechanism join{
      group, "a series that meets a closed form",
      "a threshold that is too high leaves the series' next term, one too low the closed form's cancellation",
      "the right Jacobian agrees with coefficients in 64 bits of mantissa to 10 epsilons, at 90 angles on both sides",
      "of the bound"};
  const StressMechanism gimbal{
      group, "gimbal lock",
      "near the vertical yaw and roll each come from two tiny elements, with errors of eps / cos(pitch) that do not "
      "cancel",
      "the angles give the attitude again to 20 epsilons, however near the vertical it looks", "of the bound"};
  const StressMechanism wrap{
      group, "an angle at its wrap", "-pi and pi both come out, or a tiny negative heading becomes 2 pi itself",
      "within (-pi, pi] and [0, 2 pi), the same direction to an epsilon of the angle", "of the bound"};
  const StressMechanism far{group, "a half turn far from the origin",
                            "the inverse of the translation's Jacobian is 0 / 0 or loses digits there",
                            "exp then log of a pose 10^7 m away is the identity to 30 epsilons of the way",
                            "of the bound"};
  const StressMechanism growth{StressGroup::kLong, "rounding of an attitude over many steps",
                               "the quaternion's norm drifts and shears the rotation",
                               "a full turn in a million parts closes to 2 epsilons a part, all the same way at worst",
                               "rad"};
  StressRows rows;
  rows.of(branch).add("rotation/exp_log_of_tiny_angles", [] {
    return there_and_back({1e-300, 1e-160, 1e-100, 1e-30, 1e-16, 1e-8});
  });
  rows.of(branch).add("rotation/exp_log_around_the_series_end", [] {
    return there_and_back({0.99e-4, 1e-4, 1.01e-4, 1e-3, 0.0999, 0.1, 0.1001, 1.0, 2.0});
  });
  rows.of(branch).add("rotation/exp_log_at_half_a_turn", [] {
    return there_and_back({kPi - 1e-3, kPi - 1e-8, kPi - 1e-12, kPi - 1e-15, kPi});
  });
  rows.of(join).add("rotation/right_jacobian_1e-12_to_6_rad", right_jacobian);
  rows.of(gimbal).add("rotation/angles_at_pitch_90_deg", [] { return near_the_vertical({0.0, 1e-16}); });
  rows.of(gimbal).add("rotation/angles_near_pitch_90_deg", [] {
    return near_the_vertical({1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4});
  });
  rows.of(wrap).add("rotation/angles_at_their_wrap", wrapped_angles);
  rows.of(far).add("rotation/pose_of_half_a_turn_at_1e7_m", far_poses);
  rows.of(growth).add("rotation/full_turn_in_1e6_parts", million_parts);
  return rows.take();
}

}  // namespace canyon
