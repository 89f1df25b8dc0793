#include "canyon/lidar/registration/engine/open_directions.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

constexpr double kRadius_m = 15.0;

Vector6d shift(double x, double y, double z) {
  Vector6d v = Vector6d::Zero();
  v.tail<3>() << x, y, z;
  return v;
}

/// What is shifted and what is turned err independently.
PriorLaw independent_law(const Pose& at) {
  Matrix6d P = Matrix6d::Identity();
  P.topLeftCorner<3, 3>() *= 1e-4;
  return *PriorLaw::of({.X_TS = at, .covariance = P});
}

// 2026-11-24: with the prior turned by 20 deg, what was held along a corridor was taken out of the logarithm, which
// leads off the walls by half that angle: 17 cm per metre.
TEST(OpenDirections, HoldingAPoseMovesItAlongThemAlone) {
  const OpenDirections open(kRadius_m, {shift(1, 0, 0)});
  const Pose prior{so3_exp({0.01, -0.02, 20 * kDegree}), {2, 1, 0.1}}, at{Eigen::Quaterniond::Identity(), {5, 0, 0}};
  const Pose held = open.held_at(independent_law(prior), at);
  // The corridor runs along x: what is not along it stays, to rounding (1e-15 times 30 moves of metres).
  EXPECT_NEAR(held.p.y(), at.p.y(), 1e-12);
  EXPECT_NEAR(held.p.z(), at.p.z(), 1e-12);
  EXPECT_LT(so3_log(held.R).norm(), 1e-12);
  // The prior's slope along it, in its sigma, is nothing, to the last move of 1e-9 m.
  const Matrix6d weight = independent_law(prior).covariance_at(held).inverse();
  const Vector6d v = shift(1, 0, 0);
  EXPECT_LT(std::abs(v.dot(weight * (prior.inverse() * held).log())) / std::sqrt(v.dot(weight * v)), 1e-8);
}

TEST(OpenDirections, OnLevelGroundTurnAndShiftsAreThePriors) {
  Vector6d turn = Vector6d::Zero();
  turn[2] = 1.0 / kRadius_m;
  const OpenDirections open(kRadius_m, {shift(1, 0, 0), shift(0, 1, 0), turn});
  const Pose prior{so3_exp({0, 0, 30 * kDegree}), {4, -3, 0}}, at{Eigen::Quaterniond::Identity(), {0, 0, 0.2}};
  const Pose held = open.held_at(independent_law(prior), at);
  EXPECT_NEAR(held.p.z(), 0.2, 1e-9);  // the prior's places in the plane, the ground's height
  EXPECT_LT((held.p.head<2>() - prior.p.head<2>()).norm(), 1e-8);
  EXPECT_LT(so3_log(held.R.conjugate() * prior.R).norm(), 1e-9);
}

TEST(OpenDirections, AWideDirectionIsOpened) {
  OpenDirections open(kRadius_m);
  Matrix6d P = Matrix6d::Identity() * 1e-6;
  const Vector6d wide = shift(0.6, 0.8, 0);
  P += 0.25 * wide * wide.transpose();
  open.open_wide(P, 0.4, 1.0);
  ASSERT_EQ(open.open().size(), 1u);
  EXPECT_NEAR(std::abs(open.open()[0].dot(wide)), 1.0, 1e-9);
  EXPECT_NEAR(wide.dot(open.with_open(P, 10.0) * wide), 100.0, 1e-6);
  EXPECT_EQ(open.closed_basis().cols(), 5);
  EXPECT_FALSE(open.add(wide)) << "known already";
  // Dual and basis belong together.
  EXPECT_LT((open.closed_dual() * open.closed_basis() - Eigen::MatrixXd::Identity(5, 5)).norm(), 1e-12);
}

TEST(OpenDirections, ATurnOfHalfADegreeIsWide) {
  OpenDirections open(kRadius_m);
  Matrix6d P = Matrix6d::Identity() * 1e-6;
  P(1, 1) = 1e-4;  // 0.01 rad moves 0.15 m at the radius
  open.open_wide(P, 0.4, 0.02);
  EXPECT_TRUE(open.empty());
  open.open_wide(P, 0.4, 0.005);
  ASSERT_EQ(open.open().size(), 1u);
  EXPECT_NEAR(std::abs(open.open()[0][1]), 1.0 / kRadius_m, 1e-12);
}

// What is open leans as far as the blocks' curvatures scatter about nothing, whatever that scatter has in common with
// the curvature along it.
TEST(OpenDirections, LeaningIsWhatTheBlocksScatter) {
  const OpenDirections open(kRadius_m, {shift(1, 0, 0)});
  constexpr int kBlocks = 100;
  constexpr double kCurvature = 50.0, kCross = 0.5, kSigma_m = 2.0;
  std::vector<Matrix6d> blocks(kBlocks, Matrix6d(Matrix6d::Identity() * kCurvature));
  for (int b = 0; b < kBlocks; ++b) {
    blocks[static_cast<std::size_t>(b)](3, 3) = 0;
    blocks[static_cast<std::size_t>(b)](3, 4) = blocks[static_cast<std::size_t>(b)](4, 3) =
        b % 2 == 0 ? kCross : -kCross;
  }
  Matrix6d prior = Matrix6d::Identity() * 1e-4;
  prior(3, 3) = kSigma_m * kSigma_m;
  const Matrix6d leans = open.leaning(blocks, prior).covariance;
  // sigma of the sum of as many, over the curvature of all.
  const double lean = std::sqrt(kBlocks * kBlocks / (kBlocks - 6.0)) * kCross / (kBlocks * kCurvature);
  EXPECT_NEAR(std::sqrt(leans(4, 4)), kSigma_m * lean, 1e-12);
  EXPECT_NEAR(leans(5, 5), 0.0, 1e-15);
  EXPECT_NEAR(leans(3, 3), 0.0, 1e-15);
}

TEST(OpenDirections, DirectionsThatLeanAlikeAreCounted) {
  const OpenDirections open(kRadius_m, {shift(1, 0, 0), shift(0, 1, 0)});
  std::vector<Matrix6d> blocks(100, Matrix6d(Matrix6d::Identity() * 50.0));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    blocks[b](3, 3) = blocks[b](4, 4) = 0.0;
    blocks[b](3, 5) = blocks[b](5, 3) = b % 2 == 0 ? 0.5 : -0.5;
    blocks[b](4, 5) = blocks[b](5, 4) = b % 4 < 2 ? 0.5 : -0.5;
  }
  Matrix6d prior = Matrix6d::Identity() * 1e-4;
  prior(3, 3) = prior(4, 4) = 4.0;
  EXPECT_NEAR(open.leaning(blocks, prior).directions, 2.0, 1e-9);
  prior(4, 4) = 1.0;  // shares of 4 and 1: 25 over 17
  EXPECT_NEAR(open.leaning(blocks, prior).directions, 25.0 / 17.0, 1e-9);
  prior(4, 4) = 1e-12;
  EXPECT_NEAR(open.leaning(blocks, prior).directions, 1.0, 1e-9);
}

// 400,000 draws: 400 of them lie beyond in the mean, with 20 as standard deviation; within four of these.
TEST(OpenDirections, OfAProductOneInAThousandLiesBeyondItsBound) {
  constexpr std::uint64_t kDraws = 400000;
  const RandomStream random(41, "test.product");
  const auto square = [&random](int from, int to, std::uint64_t n) {
    double sum = 0.0;
    for (int k = from; k < to; ++k) sum += std::pow(random.normal(static_cast<std::uint32_t>(k), n), 2);
    return sum;
  };
  for (int open = 1; open <= 3; ++open) {
    for (int closed = 1; closed + open <= 6; ++closed) {
      const double bound = product_over_normal(open, closed) * chi_square_threshold(1e-3, closed);
      int beyond = 0;
      for (std::uint64_t n = 0; n < kDraws; ++n)
        beyond += square(0, open, n) / open * square(open, open + closed, n) > bound ? 1 : 0;
      EXPECT_NEAR(beyond, 400, 80) << open << ' ' << closed;
    }
  }
  // Of one direction with 0.8 and one with 0.2 of the whole, counted as 1 / (0.8^2 + 0.2^2): between the lines of the
  // table it is wider by 2 %, a tenth fewer lie beyond.
  const double between = product_over_normal(1.0 / 0.68, 4) * chi_square_threshold(1e-3, 4);
  int beyond = 0;
  for (std::uint64_t n = 0; n < kDraws; ++n)
    beyond += (0.8 * square(0, 1, n) + 0.2 * square(1, 2, n)) * square(2, 6, n) > between ? 1 : 0;
  EXPECT_NEAR(beyond, 360, 80);
  EXPECT_EQ(product_over_normal(4, 2), product_over_normal(3, 2));
}

// 2026-11-26: what is open was held at the prior's own coordinates whatever the others had become. With a prior that is
// 6 m and 25 deg off, a tilt was then several of its sigma off, and the covariance did not say so.
TEST(OpenDirections, WhatIsHeldErrsAsThePriorsCovarianceSaysThere) {
  Matrix6d P = Matrix6d::Zero();
  P.diagonal() << 0.008 * 0.008, 0.008 * 0.008, 0.43 * 0.43, 16, 16, 0.01;
  const PriorLaw prior = *PriorLaw::of({.X_TS = Pose{}, .covariance = P});
  Vector6d leaning;  // a tilt, with some height and way in it
  leaning << 1.0 / kRadius_m, 0.2 / kRadius_m, 0, 0.05, 0.1, 0.5;
  OpenDirections open(kRadius_m);
  ASSERT_TRUE(open.add(leaning));
  const Vector6d v = open.open()[0];
  const RandomStream random(1, "test.held");
  constexpr int kDraws = 2000;
  double sum = 0;
  for (std::uint64_t n = 0; n < kDraws; ++n) {
    Vector6d xi;
    for (int k = 0; k < 6; ++k) xi[k] = std::sqrt(P(k, k)) * random.normal(static_cast<std::uint32_t>(k), n);
    const Pose truth = Pose::exp(xi);
    const Pose held = open.held_at(prior, truth * Pose::exp(random.normal(6, n) * v));
    const double off = v.dot((held.inverse() * truth).log()) / v.squaredNorm();
    sum += off * off * v.dot(prior.covariance_at(held).ldlt().solve(v));
  }
  // The mean of squares of as many normal numbers: 4 sigma, sqrt(2 / n) each. False alarms: 6e-5.
  EXPECT_NEAR(sum / kDraws, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
}

}  // namespace
}  // namespace canyon::lidar
