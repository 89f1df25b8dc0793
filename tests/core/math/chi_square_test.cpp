#include "canyon/core/math/chi_square.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon {
namespace {

// Two degrees of freedom: exp(-x / 2). Four: exp(-x / 2) (1 + x / 2). One: erfc(sqrt(x / 2)).
TEST(ChiSquare, ClosedForms) {
  for (const double x : {1e-6, 0.3, 1.0, 3.0, 7.0, 20.0, 100.0}) {
    EXPECT_NEAR(chi_square_tail(x, 1) / std::erfc(std::sqrt(0.5 * x)), 1.0, 1e-12) << x;
    EXPECT_NEAR(chi_square_tail(x, 2) / std::exp(-0.5 * x), 1.0, 1e-12) << x;
    EXPECT_NEAR(chi_square_tail(x, 4) / (std::exp(-0.5 * x) * (1.0 + 0.5 * x)), 1.0, 1e-12) << x;
  }
  // Many degrees of freedom: normal, mean dof, variance 2 dof; the skewness adds up to 0.5 / sqrt(dof).
  EXPECT_NEAR(chi_square_tail(1e6 + std::sqrt(2e6), 1e6), 0.5 * std::erfc(std::sqrt(0.5)), 5e-4);
  EXPECT_EQ(chi_square_tail(0.0, 3), 1.0);
  EXPECT_EQ(chi_square_tail(-1.0, 3), 1.0);
}

// Abramowitz & Stegun, table 26.8, upper percentage points.
TEST(ChiSquare, TabulatedThresholds) {
  EXPECT_NEAR(chi_square_threshold(0.001, 1), 10.828, 5e-4);
  EXPECT_NEAR(chi_square_threshold(0.001, 10), 29.588, 5e-4);
  EXPECT_NEAR(chi_square_threshold(0.05, 30), 43.773, 5e-4);
  EXPECT_NEAR(chi_square_threshold(0.5, 100), 99.3341, 5e-5);
}

TEST(ChiSquare, ThresholdIsTheInverseOfTheTail) {
  for (const int dof : {1, 2, 5, 17, 60})
    for (const double p : {1e-9, 1e-5, 1e-3, 0.3, 0.9})
      EXPECT_NEAR(chi_square_tail(chi_square_threshold(p, dof), dof) / p, 1.0, 1e-10) << dof << " " << p;
}

}  // namespace
}  // namespace canyon
