#include "canyon/fusion/propagation/markov_moments.h"

#include <limits>

#include <gtest/gtest.h>

#include "canyon/tests/fusion/propagation/van_loan.h"

namespace canyon::fusion {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// [I_1, I_2, I_3, x] as one system of four.
VanLoan chain(double dt_s, double tau_s) {
  LongMatrix F = LongMatrix::Zero(4, 4), Q = LongMatrix::Zero(4, 4);
  F(0, 3) = F(1, 0) = F(2, 1) = 1.0L;
  F(3, 3) = -1.0L / static_cast<long double>(tau_s);
  Q(3, 3) = 1.0L;
  return {F, Q, dt_s};
}

// Sixteen decades of the step to the correlation time: every moment as the matrix exponential in extended precision has
// it, to the rounding of a few dozen terms.
TEST(MarkovMoments, AreThoseOfTheMatrixExponential) {
  for (const double dt_s : {1e-4, 0.01, 1.0, 100.0}) {
    for (const double ratio : {1e-12, 1e-6, 1e-3, 0.1, 0.9, 1.0, 1.1, 3.0, 30.0, 50.0, 1e3, 1e6}) {
      const double tau_s = dt_s / ratio;
      const MarkovMoments moments(dt_s, tau_s);
      const VanLoan expected = chain(dt_s, tau_s);
      EXPECT_NEAR(moments.decay, static_cast<double>(expected.transition(3, 3)), 1e-15) << dt_s << ' ' << ratio;
      for (int i = 0; i < 4; ++i) {
        if (i < 3) {
          const auto carried = static_cast<double>(expected.transition(i, 3));
          EXPECT_NEAR(moments.carried[static_cast<std::size_t>(i)] / carried, 1.0, 1e-13) << dt_s << ' ' << ratio;
        }
        for (int j = 0; j < 4; ++j) {
          const auto noise = static_cast<double>(expected.noise(i, j));
          EXPECT_NEAR(moments.driven(i, j) / noise, 1.0, 1e-12) << dt_s << ' ' << ratio << ' ' << i << j;
        }
      }
    }
  }
}

TEST(MarkovMoments, OfARandomWalkArePowers) {
  const double dt = 0.3;
  const MarkovMoments moments(dt, kUnbounded);
  EXPECT_EQ(moments.decay, 1.0);
  EXPECT_NEAR(moments.carried[0], dt, 1e-16);
  EXPECT_NEAR(moments.carried[1], dt * dt / 2.0, 1e-16);
  EXPECT_NEAR(moments.carried[2], dt * dt * dt / 6.0, 1e-16);
  EXPECT_NEAR(moments.driven(3, 3), dt, 1e-15);
  EXPECT_NEAR(moments.driven(0, 3), dt * dt / 2.0, 1e-15);
  EXPECT_NEAR(moments.driven(2, 2), std::pow(dt, 7) / 252.0, 1e-18);
}

// A process that forgets at once is white: of density q tau^2.
TEST(MarkovMoments, BecomeThoseOfWhiteNoise) {
  const double dt = 0.5, tau = 1e-7;
  const MarkovMoments moments(dt, tau);
  const Eigen::Matrix3d white = tau * tau * white_moments(dt);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(moments.driven(i, j) / white(i, j), 1.0, 10.0 * tau / dt);
  }
}

TEST(MarkovMoments, OfWhiteNoiseAreThoseOfTheMatrixExponential) {
  LongMatrix F = LongMatrix::Zero(3, 3), Q = LongMatrix::Zero(3, 3);
  F(1, 0) = F(2, 1) = 1.0L;
  Q(0, 0) = 1.0L;
  const VanLoan expected(F, Q, 0.7);
  EXPECT_LT((white_moments(0.7) - expected.noise.cast<double>()).cwiseAbs().maxCoeff(), 1e-15);
}

}  // namespace
}  // namespace canyon::fusion
