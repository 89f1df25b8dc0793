#include "canyon/lidar/registration/engine/open_directions.h"

#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

constexpr double kRadius_m = 15.0;

Vector6d shift(double x, double y, double z) {
  Vector6d v = Vector6d::Zero();
  v.tail<3>() << x, y, z;
  return v;
}

// 2026-11-24: with the prior turned by 20 deg, what was held along a corridor was taken out of the logarithm, which
// leads off the walls by half that angle: 17 cm per metre.
TEST(OpenDirections, HoldingAPoseMovesItAlongThemAlone) {
  const OpenDirections open(kRadius_m, {shift(1, 0, 0)});
  const Pose prior{so3_exp({0.01, -0.02, 20 * kDegree}), {2, 1, 0.1}}, at{Eigen::Quaterniond::Identity(), {5, 0, 0}};
  const Pose held = open.held_at(prior, at);
  // The corridor runs along x: what is not along it stays, to rounding (1e-15 times 30 moves of metres).
  EXPECT_NEAR(held.p.y(), at.p.y(), 1e-12);
  EXPECT_NEAR(held.p.z(), at.p.z(), 1e-12);
  EXPECT_LT(so3_log(held.R).norm(), 1e-12);
  const Vector6d xi = (prior.inverse() * held).log();
  EXPECT_LT((xi - open.closed_part(xi)).norm(), 1e-9);  // kHeld
}

TEST(OpenDirections, OnLevelGroundTurnAndShiftsAreThePriors) {
  Vector6d turn = Vector6d::Zero();
  turn[2] = 1.0 / kRadius_m;
  const OpenDirections open(kRadius_m, {shift(1, 0, 0), shift(0, 1, 0), turn});
  const Pose prior{so3_exp({0, 0, 30 * kDegree}), {4, -3, 0}}, at{Eigen::Quaterniond::Identity(), {0, 0, 0.2}};
  const Pose held = open.held_at(prior, at);
  EXPECT_NEAR(held.p.z(), 0.2, 1e-9);  // the prior's places in the plane, the ground's height
  EXPECT_LT((held.p.head<2>() - prior.p.head<2>()).norm(), 1e-8);
  EXPECT_LT(so3_log(held.R.conjugate() * prior.R).norm(), 1e-9);
}

TEST(OpenDirections, AWideDirectionIsOpened) {
  OpenDirections open(kRadius_m);
  Matrix6d P = Matrix6d::Identity() * 1e-6;
  const Vector6d wide = shift(0.6, 0.8, 0);
  P += 0.25 * wide * wide.transpose();
  open.open_wide(P, 0.4);
  ASSERT_EQ(open.open().size(), 1u);
  EXPECT_NEAR(std::abs(open.open()[0].dot(wide)), 1.0, 1e-9);
  EXPECT_NEAR(wide.dot(open.with_open(P, 10.0) * wide), 100.0, 1e-6);
  EXPECT_EQ(open.closed_basis().cols(), 5);
  EXPECT_FALSE(open.add(wide)) << "known already";
  // Dual and basis belong together.
  EXPECT_LT((open.closed_dual() * open.closed_basis() - Eigen::MatrixXd::Identity(5, 5)).norm(), 1e-12);
}

}  // namespace
}  // namespace canyon::lidar
