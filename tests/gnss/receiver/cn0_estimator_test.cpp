#include "canyon/gnss/receiver/reports/cn0_estimator.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::gnss {
namespace {

TEST(Cn0Estimator, IsExactUnlessToldOtherwise) {
  const Cn0Estimator exact(3, "test.cn0", {}, 0.02, 0.5);
  EXPECT_EQ(exact.reported_dbhz(31.234567, 7, 12), 31.234567);
  const Cn0Estimator rounding(3, "test.cn0", {0.0, 1.0}, 0.02, 0.5);
  EXPECT_EQ(rounding.reported_dbhz(31.6, 7, 12), 32.0);
}

// 4000 satellites at one epoch: standard deviation within 4 / sqrt(2 * 4000) = 4.5 %, mean within 4 sigma / sqrt(4000);
// one epoch later the noise has kept exp(-dt / averaging), correlation within 4 / sqrt(4000).
TEST(Cn0Estimator, HasTheNoiseOfItsBoundAndForgetsAsItAverages) {
  constexpr int kN = 4000;
  const Cn0Estimator e(3, "test.cn0", {1.0, 0.0}, 0.02, 0.5);
  const double sigma = cn0_noise_db(28.0, 1.0, 0.02);
  double sum = 0.0, squares = 0.0, product = 0.0;
  for (std::uint32_t i = 0; i < kN; ++i) {
    const double a = e.reported_dbhz(28.0, i, 40) - 28.0, b = e.reported_dbhz(28.0, i, 41) - 28.0;
    sum += a;
    squares += a * a;
    product += a * b;
  }
  EXPECT_NEAR(sum / kN, 0.0, 4.0 * sigma / std::sqrt(kN));
  EXPECT_NEAR(std::sqrt(squares / kN), sigma, 4.0 * sigma / std::sqrt(2.0 * kN));
  EXPECT_NEAR(product / squares, std::exp(-0.5), 4.0 / std::sqrt(kN));
}

// The bound against an estimator that reaches it where the signal is known: mean of the in-phase part squared over the
// noise power. 3000 trials of 50 correlations at 40 dB-Hz and 20 ms: 4 sigma of a standard deviation, 5.2 %, and what
// the bound of K samples leaves out, 2 / K = 4 %.
TEST(Cn0Estimator, TheBoundIsWhatCorrelationsScatterBy) {
  constexpr int kTrials = 3000, kSamples = 50;
  const double rho = 1e4 * 0.02;
  const RandomStream draws(5, "test.correlations");
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    double mean_i = 0.0, mean_q = 0.0, power = 0.0;
    for (std::uint64_t k = 0; k < kSamples; ++k) {
      const double i = std::sqrt(rho) + std::sqrt(0.5) * draws.normal(trial, k, 0);
      const double q = std::sqrt(0.5) * draws.normal(trial, k, 1);
      mean_i += i / kSamples;
      mean_q += q / kSamples;
      power += (i * i + q * q) / kSamples;
    }
    const double noise = (power - mean_i * mean_i - mean_q * mean_q) * kSamples / (kSamples - 1);
    const double db = 10.0 * std::log10(mean_i * mean_i / noise);
    sum += db;
    squares += db * db;
  }
  const double sigma = std::sqrt(squares / kTrials - sum / kTrials * sum / kTrials);
  EXPECT_NEAR(sigma / cn0_noise_db(40.0, 1.0, 0.02), 1.0, 0.052 + 0.04);
}

}  // namespace
}  // namespace canyon::gnss
