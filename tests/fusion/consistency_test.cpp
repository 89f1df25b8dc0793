#include "canyon/fusion/consistency.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::fusion {
namespace {

TEST(Consistency, ChiSquareTailsAreTheTabulatedOnes) {
  // Quantiles with three decimals, Abramowitz & Stegun table 26.8.
  const struct {
    double x;
    int dof;
    double tail;
  } rows[] = {{3.841, 1, 0.05}, {5.991, 2, 0.05},   {7.815, 3, 0.05},   {16.266, 3, 0.001},
              {9.488, 4, 0.05}, {18.307, 10, 0.05}, {24.996, 15, 0.05}, {43.773, 30, 0.05}};
  for (const auto& row : rows) EXPECT_NEAR(chi_square_tail(row.x, row.dof), row.tail, 2e-3 * row.tail) << row.dof;
  for (int dof = 1; dof <= 100; ++dof) EXPECT_EQ(chi_square_tail(0.0, dof), 1.0) << dof;
  EXPECT_NEAR(chi_square_tail(16.0, 1), normal_two_sided_tail(4.0), 1e-18);
  EXPECT_NEAR(normal_two_sided_tail(3.0), 2.6998e-3, 1e-7);
}

TEST(Consistency, BandIsThatOfTheDistribution) {
  // chi-square(30): 2.5 % below 16.791, above 46.979.
  const Band band = mean_chi_square_band(3, 10, 0.05);
  EXPECT_NEAR(band.low * 10, 16.791, 0.01 * 16.791);
  EXPECT_NEAR(band.high * 10, 46.979, 0.01 * 46.979);
  EXPECT_TRUE(band.contains(3.0));
  EXPECT_FALSE(band.contains(5.0));
  // Widening as certainty is asked for, narrowing with data.
  EXPECT_GT(mean_chi_square_band(3, 10, 0.001).high, band.high);
  EXPECT_LT(mean_chi_square_band(3, 1000, 0.05).high, band.high);
}

TEST(Consistency, NormalizedSquaredOfDrawnErrorsAveragesTheirDimension) {
  Eigen::Matrix3d A;
  A << 2.0, 0.0, 0.0, -1.0, 0.5, 0.0, 0.3, 0.2, 0.1;
  const Eigen::Matrix3d P = A * A.transpose();
  const RandomStream stream(3, "test.nees");
  ConsistencyMean mean;
  const int n = 2000;
  for (std::uint64_t i = 0; i < n; ++i) {
    const Eigen::Vector3d e = A * stream.normal3(i);
    mean.add(normalized_squared(e, P), 3);
  }
  EXPECT_TRUE(mean_chi_square_band(3, n, 1e-4).contains(3.0 * mean.per_state())) << mean.per_state();
  EXPECT_EQ(mean.count(), n);
  EXPECT_TRUE(std::isnan(ConsistencyMean().per_state()));
  EXPECT_TRUE(std::isnan(normalized_squared(Eigen::Vector3d::Ones(), Eigen::Matrix3d(-P))));
}

}  // namespace
}  // namespace canyon::fusion
