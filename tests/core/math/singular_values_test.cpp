#include "canyon/core/math/singular_values.h"

#include <gtest/gtest.h>

namespace canyon {
namespace {

// A = U diag V^T by hand: values, solution, and what a weak direction leaves.
TEST(SingularValues, OfAKnownMatrix) {
  Eigen::MatrixXd A(3, 2);
  A << 3.0, 0.0, 0.0, 1e-12, 0.0, 0.0;
  const SingularValues s(A);
  EXPECT_DOUBLE_EQ(s.values[0], 3.0);
  EXPECT_DOUBLE_EQ(s.values[1], 1e-12);
  EXPECT_LT((s.U * s.values.asDiagonal() * s.V.transpose() - A).norm(), 1e-15);
  const Eigen::Vector3d b(6.0, 2e-12, 5.0);
  EXPECT_LT((s.solve(b, 1e-14) - Eigen::Vector2d(2.0, 2.0)).norm(), 1e-12);
  EXPECT_LT((s.solve(b, 1e-9) - Eigen::Vector2d(2.0, 0.0)).norm(), 1e-15);
}

}  // namespace
}  // namespace canyon
