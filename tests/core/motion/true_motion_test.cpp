#include "canyon/core/motion/true_motion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon {
namespace {

constexpr GpsTime kMotionStart{1'000'000'000'000'000'000};

/// A body on a helix that turns about all axes; derivatives by hand.
KinematicState helix(double t_s) {
  const double r = 20.0, w = 0.7;
  KinematicState k;
  k.t = kMotionStart + t_s;
  k.X_WB.p = {r * std::cos(w * t_s), r * std::sin(w * t_s), 0.3 * t_s};
  k.v_WB_W = {-r * w * std::sin(w * t_s), r * w * std::cos(w * t_s), 0.3};
  k.a_WB_W = {-r * w * w * std::cos(w * t_s), -r * w * w * std::sin(w * t_s), 0.0};
  // R = Exp(axis * angle), angle = 0.2 sin(3 t): a fixed axis, so rate and acceleration lie along it.
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  k.X_WB.R = so3_exp(0.2 * std::sin(3.0 * t_s) * axis);
  k.w_WB_B = 0.6 * std::cos(3.0 * t_s) * axis;
  k.alpha_WB_B = -1.8 * std::sin(3.0 * t_s) * axis;
  return k;
}

TrueMotion helix_motion(double step_s, int nodes) {
  TrueMotion motion;
  for (int i = 0; i < nodes; ++i) motion.append(helix(step_s * i));
  return motion;
}

TEST(TrueMotion, IsItsNodesToTheBit) {
  const TrueMotion motion = helix_motion(0.01, 50);
  for (int i = 0; i < 50; ++i) {
    const KinematicState node = helix(0.01 * i), at = motion.at(node.t);
    EXPECT_EQ(at.X_WB.p, node.X_WB.p);
    EXPECT_EQ(at.X_WB.R.coeffs(), node.X_WB.R.coeffs());
    EXPECT_EQ(at.alpha_WB_B, node.alpha_WB_B);
  }
}

// Hermite interpolation of fifth degree: the error of the position is at most h^6 / 46080 times its sixth derivative,
// here r w^6 = 2.35 m/s^6; of the acceleration it falls with h^4. Halving the step must show both orders.
TEST(TrueMotion, ErrorFallsWithTheSixthAndFourthPowerOfTheStep) {
  double position[2] = {0, 0}, acceleration[2] = {0, 0};
  for (int halved = 0; halved < 2; ++halved) {
    const double h = halved == 0 ? 0.4 : 0.2;
    const TrueMotion motion = helix_motion(h, halved == 0 ? 6 : 11);
    for (int k = 1; k < 200; ++k) {
      const KinematicState truth = helix(0.01 * k), at = motion.at(truth.t);
      position[halved] = std::max(position[halved], (at.X_WB.p - truth.X_WB.p).norm());
      acceleration[halved] = std::max(acceleration[halved], (at.a_WB_W - truth.a_WB_W).norm());
    }
    EXPECT_LT(position[halved], std::pow(h, 6) / 46080.0 * 20.0 * std::pow(0.7, 6) * 1.01);
  }
  EXPECT_NEAR(std::log2(position[0] / position[1]), 6.0, 0.3);
  EXPECT_NEAR(std::log2(acceleration[0] / acceleration[1]), 4.0, 0.4);
}

// Between nodes rate and angular acceleration are the derivatives of the attitude, and so on, whatever the nodes are:
// here nodes whose derivatives do not even fit their poses. Central differences over 2 d: error d^2 / 6 times the third
// derivative. A quintic over h = 10 ms whose rate is off by 0.23 rad/s at an end has fourth derivatives of up to
// (24 x 15 + 120 x 6) x 0.23 / h^3 = 2.5e8; angular accelerations are of the order of 100 rad/s^2.
TEST(TrueMotion, DerivativesFitTogetherBetweenNodesOfAnyKind) {
  TrueMotion motion;
  for (int i = 0; i < 4; ++i) {
    KinematicState node = helix(0.01 * i);
    node.w_WB_B += Eigen::Vector3d(0.1, -0.2, 0.05 * i);
    node.alpha_WB_B += Eigen::Vector3d(3.0, 1.0, -2.0);
    node.a_WB_W += Eigen::Vector3d(1.0, 0.0, 0.5 * i);
    motion.append(node);
  }
  const double d = 1e-5, tolerance = d * d / 6.0 * 2.5e8;
  for (double t_s = 0.0005; t_s < 0.0295; t_s += 0.001) {
    if (std::abs(std::remainder(t_s, 0.01)) < 2 * d) continue;
    const KinematicState before = motion.at(kMotionStart + (t_s - d)), now = motion.at(kMotionStart + t_s),
                         after = motion.at(kMotionStart + (t_s + d));
    EXPECT_LT(((after.X_WB.p - before.X_WB.p) / (2 * d) - now.v_WB_W).norm(), tolerance);
    EXPECT_LT(((after.v_WB_W - before.v_WB_W) / (2 * d) - now.a_WB_W).norm(), tolerance);
    EXPECT_LT((so3_log(before.X_WB.R.conjugate() * after.X_WB.R) / (2 * d) - now.w_WB_B).norm(), tolerance);
    EXPECT_LT(((after.w_WB_B - before.w_WB_B) / (2 * d) - now.alpha_WB_B).norm(), tolerance);
  }
}

// Pieces end at the nodes, whatever the interval, and their integrals add up: the integral of the velocity is the way.
TEST(TrueMotion, PiecesCoverAnyIntervalOnce) {
  const TrueMotion motion = helix_motion(0.01, 30);
  const GpsTime from = kMotionStart + 0.0137, to = kMotionStart + 0.2512;
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  GpsTime last = from;
  int pieces = 0;
  motion.for_each_piece(from, to, [&](const TrueMotion::Piece& piece) {
    EXPECT_EQ(piece.front().t, last);
    last = piece.back().t;
    const double h = piece.back().t - piece.front().t;
    way += h / 90.0 *
           (7.0 * piece[0].v_WB_W + 32.0 * piece[1].v_WB_W + 12.0 * piece[2].v_WB_W + 32.0 * piece[3].v_WB_W +
            7.0 * piece[4].v_WB_W);
    ++pieces;
  });
  EXPECT_EQ(last, to);
  EXPECT_EQ(pieces, 25);
  // Boole's rule integrates the quartic velocity exactly; what is left is rounding of 25 sums of |p| = 20 m.
  EXPECT_LT((way - (motion.at(to).X_WB.p - motion.at(from).X_WB.p)).norm(), 25 * 20 * 2.3e-16 * 10);
}

TEST(TrueMotion, ForgetsWhatIsNotNeededAndRefusesWhatItDoesNotKnow) {
  TrueMotion motion = helix_motion(0.01, 30);
  motion.forget_before(kMotionStart + 0.105);
  EXPECT_EQ(motion.first(), kMotionStart + 0.1);
  EXPECT_THROW(motion.at(kMotionStart + 0.05), ProgramError);
  EXPECT_THROW(motion.at(kMotionStart + 0.5), ProgramError);
  EXPECT_THROW(motion.append(helix(0.1)), ProgramError);
  KinematicState turned = helix(0.3);
  turned.X_WB.R = turned.X_WB.R * so3_exp({0, 0, 1.5});
  EXPECT_THROW(motion.append(turned), ProgramError);
}

}  // namespace
}  // namespace canyon
