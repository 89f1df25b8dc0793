#include "canyon/gnss/errors/gauss_markov.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon::gnss {
namespace {

const GpsTime kMarkovStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

// Sample points 3 tau apart are correlated by e^-3 = 0.05, so 2000 of them count as 2000 / (1 + 2 e^-6) for the
// variance. 5 sigma.
TEST(GaussMarkov, UnitVarianceAtEveryPhaseBetweenNodes) {
  const double tau_s = 80.0;  // nodes every 10 s
  const GaussMarkov process(5, "test.gm", tau_s);
  constexpr int kN = 2000;
  for (const double phase_s : {0.0, 2.5, 5.0, 9.0}) {
    double sum = 0.0, square = 0.0;
    for (int k = 0; k < kN; ++k) {
      const double x = process.at(3, kMarkovStart + (phase_s + 3.0 * tau_s * k));
      sum += x;
      square += x * x;
    }
    EXPECT_NEAR(square / kN, 1.0, 5.0 * std::sqrt(2.0 / kN * 1.01)) << phase_s;
    EXPECT_NEAR(sum / kN, 0.0, 5.0 * std::sqrt(1.0 / kN * 1.11)) << phase_s;
  }
}

// Correlation exp(-L / tau): exact from node to node. Var of a product of two correlated normals is 1 + rho^2 <= 2; 5
// sigma. Between nodes interpolation adds at most 0.02.
TEST(GaussMarkov, CorrelationFallsExponentially) {
  const double tau_s = 80.0;
  const GaussMarkov process(5, "test.gm", tau_s);
  constexpr int kN = 4000;
  for (const double lag_s : {10.0, 40.0, 80.0, 160.0, 33.0}) {
    double sum = 0.0;
    for (int k = 0; k < kN; ++k) {
      const GpsTime t = kMarkovStart + 4.0 * tau_s * k;
      sum += process.at(0, t) * process.at(0, t + lag_s);
    }
    const double between_nodes = lag_s == 33.0 ? 0.02 : 0.0;
    EXPECT_NEAR(sum / kN, std::exp(-lag_s / tau_s), 5.0 * std::sqrt(2.0 * 1.01 / kN) + between_nodes) << lag_s;
  }
}

TEST(GaussMarkov, ContinuousAcrossNodesAndIndependentByEntity) {
  const GaussMarkov process(5, "test.gm", 80.0);
  for (int k = 0; k < 50; ++k) {
    const GpsTime node = kMarkovStart + 10.0 * k;
    EXPECT_NEAR(process.at(1, node + -1e-6), process.at(1, node + 1e-6), 1e-5);
    EXPECT_NE(process.at(1, node), process.at(2, node));
  }
  EXPECT_TRUE(std::isfinite(process.at(0, GpsTime{0})));  // the epoch itself
}

TEST(GaussMarkov, DoesNotDependOnWhatWasAskedBefore) {
  const GaussMarkov a(5, "test.gm", 80.0), b(5, "test.gm", 80.0);
  const double value = a.at(1, kMarkovStart + 77.0);
  for (int k = 0; k < 10; ++k) b.at(static_cast<std::uint32_t>(k), kMarkovStart + 1000.0 * k);
  EXPECT_EQ(b.at(1, kMarkovStart + 77.0), value);
}

}  // namespace
}  // namespace canyon::gnss
