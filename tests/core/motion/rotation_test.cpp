#include "canyon/core/motion/rotation.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

constexpr double kRotationEps = std::numeric_limits<double>::epsilon();
const RandomStream kRandom(1, "test.rotation");

/// Angles through every branch: zero, the series, their borders, ordinary ones, just under and at pi.
const std::vector<double> kAngles = {0.0,   1e-300, 1e-12, 1e-8, 9.9e-5, 1.01e-4,    1e-3,       0.03,        0.0999,
                                     0.101, 0.2,    1.0,   2.0,  3.0,    kPi - 1e-3, kPi - 1e-8, kPi - 1e-15, kPi};

TEST(Skew, IsTheCrossProduct) {
  const Eigen::Vector3d a(1, 2, 3), b(-4, 5, 0.5);
  EXPECT_EQ(skew(a) * b, a.cross(b));
}

TEST(So3, ExpIsTheRotationAboutTheAxis) {
  for (const double angle : kAngles) {
    for (std::uint64_t i = 0; i < 20; ++i) {
      const Eigen::Vector3d axis = kRandom.direction(0, i);
      const Eigen::Quaterniond q = so3_exp(angle * axis);
      EXPECT_NEAR(q.norm(), 1.0, 4 * kRotationEps);
      EXPECT_LT((q.toRotationMatrix() - Eigen::AngleAxisd(angle, axis).toRotationMatrix()).cwiseAbs().maxCoeff(),
                16 * kRotationEps)
          << angle;
    }
  }
}

TEST(So3, LogInvertsExp) {
  for (const double angle : kAngles) {
    for (std::uint64_t i = 0; i < 20; ++i) {
      const Eigen::Vector3d v = angle * kRandom.direction(1, i);
      const Eigen::Quaterniond q = so3_exp(v);
      const Eigen::Vector3d back = so3_log(q);
      EXPECT_LE(back.norm(), kPi * (1 + 2 * kRotationEps));
      // Relative, also for the tiniest angles; at pi the axis may come back turned round.
      const bool turned_round = angle > kPi - 1e-14 && back.dot(v) < 0;
      const double tolerance = 16 * kRotationEps * angle + 1e-320;
      EXPECT_LT(((turned_round ? -1.0 : 1.0) * back - v).norm(), tolerance) << angle;
      const Eigen::Vector3d of_minus_q = so3_log({-q.w(), -q.x(), -q.y(), -q.z()});
      EXPECT_LT(((of_minus_q.dot(v) < 0 ? -1.0 : 1.0) * of_minus_q - v).norm(), tolerance) << angle;
    }
  }
}

// On either side of the series' ends, in long double: each component to two units of its last digit.
TEST(So3, ExpAndItsJacobianHoldEveryDigit) {
  for (const double angle : {1e-8, 9.99e-5, 1.001e-4, 1e-3, 0.05, 0.09999, 0.1000001, 0.3, 1.5}) {
    const Eigen::Quaterniond q = so3_exp({angle, 0.0, 0.0});
    const Eigen::Matrix3d J = so3_right_jacobian({angle, 0.0, 0.0});
    const long double a = angle, half = 0.5L * a;
    EXPECT_NEAR(q.w(), static_cast<double>(std::cos(half)), 2 * kRotationEps) << angle;
    EXPECT_NEAR(q.x() / static_cast<double>(std::sin(half)), 1.0, 2 * kRotationEps) << angle;
    const auto across = static_cast<double>(2.0L * std::sin(half) * std::sin(half) / a);
    EXPECT_NEAR(J(1, 2) / across, 1.0, 4 * kRotationEps) << angle;
    EXPECT_NEAR(J(1, 1), static_cast<double>(std::sin(a) / a), 2 * kRotationEps) << angle;
  }
}

// Exp(v + d) = Exp(v) Exp(Jr d) + second order; the central difference leaves step^2 / 6 times a third derivative of
// order 1.
TEST(So3, RightJacobianByDifferences) {
  constexpr double step = 1e-5;
  for (const double angle : {0.0, 1e-6, 9.9e-5, 1.01e-4, 1e-2, 0.0999, 0.1001, 0.7, 2.0, 3.1}) {
    for (std::uint64_t i = 0; i < 5; ++i) {
      const Eigen::Vector3d v = angle * kRandom.direction(2, i);
      Eigen::Matrix3d numerical;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(k);
        numerical.col(k) =
            (so3_log(so3_exp(v).conjugate() * so3_exp(v + d)) - so3_log(so3_exp(v).conjugate() * so3_exp(v - d))) /
            (2 * step);
      }
      EXPECT_LT((so3_right_jacobian(v) - numerical).cwiseAbs().maxCoeff(), step * step + 8 * kRotationEps / step)
          << angle;
    }
  }
}

TEST(YawPitchRoll, RoundTripAndMeaning) {
  for (double yaw = -3.0; yaw < 3.1; yaw += 0.5) {
    for (double pitch = -1.5; pitch < 1.55; pitch += 0.3) {
      for (double roll = -3.0; roll < 3.1; roll += 0.6) {
        const Eigen::Quaterniond q = rotation_from({yaw, pitch, roll});
        const YawPitchRoll back = yaw_pitch_roll(q);
        const double tolerance = 16 * kRotationEps / std::cos(pitch);
        EXPECT_NEAR(back.yaw_rad, yaw, tolerance);
        EXPECT_NEAR(back.pitch_rad, pitch, tolerance);
        EXPECT_NEAR(back.roll_rad, roll, tolerance);
      }
    }
  }
  // Yaw turns x to y (left); positive pitch lowers the nose; positive roll lowers the right side (y, the left, rises).
  EXPECT_GT((rotation_from({0.1, 0, 0}) * Eigen::Vector3d::UnitX()).y(), 0);
  EXPECT_LT((rotation_from({0, 0.1, 0}) * Eigen::Vector3d::UnitX()).z(), 0);
  EXPECT_GT((rotation_from({0, 0, 0.1}) * Eigen::Vector3d::UnitY()).z(), 0);
}

TEST(YawPitchRoll, StraightUpAndDownStillGiveTheRotation) {
  for (const double pitch : {kPi / 2, -kPi / 2}) {
    for (const double yaw : {-2.0, 0.3, 3.0}) {
      const Eigen::Quaterniond q = rotation_from({yaw, pitch, 0.4});
      const YawPitchRoll angles = yaw_pitch_roll(q);
      // cos(pitch) is known to sqrt(eps) only there.
      EXPECT_LT(q.angularDistance(rotation_from(angles)), 4 * std::sqrt(kRotationEps));
      EXPECT_NEAR(angles.pitch_rad, pitch, 4 * std::sqrt(kRotationEps));
    }
  }
}

TEST(Heading, FromYawAndBack) {
  EXPECT_DOUBLE_EQ(heading_from_yaw(kPi / 2), 0.0);    // north
  EXPECT_DOUBLE_EQ(heading_from_yaw(0.0), kPi / 2);    // east
  EXPECT_DOUBLE_EQ(heading_from_yaw(-kPi / 2), kPi);   // south
  EXPECT_DOUBLE_EQ(heading_from_yaw(kPi), 1.5 * kPi);  // west
  for (double yaw = -20.0; yaw < 20.0; yaw += 0.37) {
    const double heading = heading_from_yaw(yaw);
    EXPECT_GE(heading, 0.0);
    EXPECT_LT(heading, 2 * kPi);
    EXPECT_NEAR(wrap_pi(yaw_from_heading(heading) - yaw), 0.0, 32 * kRotationEps * 20);
  }
  EXPECT_LT(heading_from_yaw(std::nextafter(kPi / 2, 2.0)), 2 * kPi);
}

TEST(WrapPi, HalfOpenInterval) {
  EXPECT_EQ(wrap_pi(0.0), 0.0);
  EXPECT_EQ(wrap_pi(kPi), kPi);
  EXPECT_EQ(wrap_pi(-kPi), kPi);
  EXPECT_EQ(wrap_pi(3 * kPi), kPi);
  EXPECT_NEAR(wrap_pi(7.0), 7.0 - 2 * kPi, 4 * kRotationEps * 7);
  EXPECT_NEAR(wrap_pi(-7.0), 2 * kPi - 7.0, 4 * kRotationEps * 7);
}

Pose random_pose(std::uint64_t i, double angle) {
  const Eigen::Vector3d v = angle * kRandom.direction(3, i);
  return {so3_exp(v), 10.0 * kRandom.normal3(i)};
}

// Independent of the closed form: Exp(xi) is the limit of (I + xi^ / n)^n; with 2^k steps by squaring of the Taylor sum
// of eighth order, whose first neglected term is (|xi| / 2^k)^9 / 9!.
TEST(Se3, ExpIsTheMatrixExponentialWithCoupledTranslation) {
  for (const double angle : {0.0, 1e-9, 9.9e-5, 1.01e-4, 0.0999, 0.1001, 0.3, 2.0, 3.1}) {
    for (std::uint64_t i = 0; i < 10; ++i) {
      Vector6d xi;
      xi << angle * kRandom.direction(4, i), 5.0 * kRandom.direction(5, i);
      Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
      generator.topLeftCorner<3, 3>() = skew(xi.head<3>());
      generator.topRightCorner<3, 1>() = xi.tail<3>();
      constexpr int kSquarings = 8;
      const Eigen::Matrix4d small = generator / (1 << kSquarings);
      Eigen::Matrix4d term = Eigen::Matrix4d::Identity(), sum = term;
      for (int k = 1; k <= 8; ++k) {
        term = term * small / k;
        sum += term;
      }
      for (int k = 0; k < kSquarings; ++k) sum = (sum * sum).eval();
      EXPECT_LT((Pose::exp(xi).matrix() - sum).cwiseAbs().maxCoeff(), (1 << kSquarings) * 8 * kRotationEps * 6)
          << angle;
    }
  }
}

TEST(Se3, LogInvertsExp) {
  for (const double angle : kAngles) {
    if (angle > kPi - 1e-12) continue;  // there two rotation vectors are one rotation
    for (std::uint64_t i = 0; i < 20; ++i) {
      Vector6d xi;
      xi << angle * kRandom.direction(6, i), 5.0 * kRandom.direction(7, i);
      EXPECT_LT((Pose::exp(xi).log() - xi).cwiseAbs().maxCoeff(), 64 * kRotationEps * 5) << angle;
    }
  }
}

TEST(Se3, ExpInvertsLogAtHalfATurn) {
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Pose X = random_pose(i, kPi);
    EXPECT_LT((Pose::exp(X.log()).matrix() - X.matrix()).cwiseAbs().maxCoeff(), 64 * kRotationEps * X.p.norm());
  }
}

TEST(Pose, GroupLaws) {
  const Pose A = random_pose(1, 0.8), B = random_pose(2, 2.4);
  const Eigen::Vector3d p(1, -2, 3);
  EXPECT_LT(((A * B) * p - A * (B * p)).norm(), 64 * kRotationEps * 60);
  EXPECT_LT((A.inverse() * (A * p) - p).norm(), 64 * kRotationEps * 60);
  EXPECT_LT(((A * B).matrix() - A.matrix() * B.matrix()).cwiseAbs().maxCoeff(), 64 * kRotationEps * 60);
  EXPECT_LT((Pose::from_matrix(A.matrix()).matrix() - A.matrix()).cwiseAbs().maxCoeff(), 16 * kRotationEps);
  EXPECT_EQ((A.matrix().row(3)), Eigen::RowVector4d(0, 0, 0, 1));
}

TEST(Interpolate, EndsAreExactAndTheMiddleIsHalfWay) {
  const Pose A = random_pose(3, 0.5), B = random_pose(4, 1.9);
  EXPECT_EQ(interpolate(A, B, 0.0).matrix(), A.matrix());
  EXPECT_EQ(interpolate(A, B, 1.0).matrix(), B.matrix());
  const Pose half = interpolate(A, B, 0.5);
  const Pose step = A.inverse() * half;
  EXPECT_LT(((A * step * step).matrix() - B.matrix()).norm(), 256 * kRotationEps * 30);
}

// A body that turns and drives at constant rates in its own frame moves on the SE(3) geodesic: a circle, not a chord.
TEST(Interpolate, FollowsACircle) {
  constexpr double radius = 20.0, turn = 1.2;
  const auto on_circle = [&](double a) {
    return Pose{rotation_from({a, 0, 0}), {radius * std::sin(a), radius * (1 - std::cos(a)), 0}};
  };
  for (const double s : {0.1, 0.37, 0.5, 0.9}) {
    const Pose X = interpolate(on_circle(0), on_circle(turn), s);
    EXPECT_LT((X.p - on_circle(s * turn).p).norm(), 32 * kRotationEps * radius);
    EXPECT_LT(X.R.angularDistance(on_circle(s * turn).R), 32 * kRotationEps);
  }
}

}  // namespace
}  // namespace canyon
