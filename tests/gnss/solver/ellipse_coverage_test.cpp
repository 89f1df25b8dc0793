#include "canyon/gnss/solver/ellipse_coverage.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

// 4000 errors drawn from their own covariance: shares within 4 sqrt(p (1 - p) / N); the log score is the normal's
// entropy with its sign turned, -log(2 pi sigma_e sigma_n) - 1, within 4 / sqrt(N) (half a chi-square of 2 has variance
// 1).
TEST(EllipseCoverage, OfErrorsFromTheirOwnCovariance) {
  const RandomStream draws(8, "test.ellipse");
  EllipseCoverage coverage;
  constexpr int kN = 4000;
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  P.diagonal() << 9.0, 0.25, 100.0;
  for (std::uint32_t i = 0; i < kN; ++i)
    coverage.add(Eigen::Vector3d(3.0 * draws.normal(i, 0, 0), 0.5 * draws.normal(i, 0, 1), 77.0), P);
  for (const double p : {0.5, 0.95, 0.997})
    EXPECT_NEAR(coverage.inside(p), p, 4.0 * std::sqrt(p * (1.0 - p) / kN)) << p;
  const double beyond = std::exp(-4.5);
  EXPECT_NEAR(coverage.beyond_3_sigma(), beyond, 4.0 * std::sqrt(beyond * (1.0 - beyond) / kN));
  EXPECT_NEAR(coverage.log_score(), -std::log(2.0 * kPi * 1.5) - 1.0, 4.0 / std::sqrt(kN));
}

TEST(EllipseCoverage, WhatHasNoCovarianceDoesNotCount) {
  EllipseCoverage coverage;
  coverage.add(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Constant(kNaN));
  coverage.add(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
  EXPECT_EQ(coverage.count(), 0u);
  EXPECT_TRUE(std::isnan(coverage.inside(0.5)) && std::isnan(coverage.log_score()));
}

}  // namespace
}  // namespace canyon::gnss
