#include "canyon/study/statistics/block_bootstrap.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

// Of n independent normal values the RMS has sigma 1 / sqrt(2 n); the bootstrap's own is known to a few per cent of
// that (1000 replicates: 2 %; 400 samples: the fourth moment to 10 %), averaged here over 20 seeds.
TEST(BlockBootstrap, SigmaOfIndependentValues) {
  constexpr std::size_t kSamples = 400;
  double mean_sigma = 0.0;
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<SquareSum> samples(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double x = RandomStream(seed, "test").normal(0, i);
      samples[i] = {x * x, 1.0};
    }
    const RmsEstimate e = block_bootstrap_rms(samples, seed);
    mean_sigma += e.sigma / 20.0;
    held += e.interval.low <= 1.0 && 1.0 <= e.interval.high ? 1 : 0;
  }
  EXPECT_NEAR(mean_sigma * std::sqrt(2.0 * kSamples), 1.0, 0.1);
  // At 95 % fewer than 15 of 20 happen once in 3000 times.
  EXPECT_GE(held, 15);
}

// Values that are alike in runs of eight say as much as an eighth of them: sigma grows by sqrt(8), of which blocks of
// 400^(1/3) = 8 samples see the most part (1 - 1/3 of the covariance: the triangle's weight), single samples nothing.
TEST(BlockBootstrap, AlikeNeighboursWidenIt) {
  constexpr std::size_t kSamples = 400;
  double mean_sigma = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<SquareSum> samples(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double x = RandomStream(seed, "test").normal(0, i / 8);
      samples[i] = {x * x, 1.0};
    }
    mean_sigma += block_bootstrap_rms(samples, seed).sigma / 20.0;
  }
  EXPECT_GT(mean_sigma * std::sqrt(2.0 * kSamples), 0.7 * std::sqrt(8.0));
}

TEST(BlockBootstrap, WithoutValuesUndefined) {
  EXPECT_TRUE(std::isnan(block_bootstrap_rms({}, 1).rms));
  const std::vector<SquareSum> one{{4.0, 1.0}};
  EXPECT_EQ(block_bootstrap_rms(one, 1).rms, 2.0);
  EXPECT_TRUE(std::isnan(block_bootstrap_rms(one, 1).sigma));
  const std::vector<SquareSum> empty(5);
  EXPECT_TRUE(std::isnan(block_bootstrap_rms(empty, 1).rms));
}

}  // namespace
}  // namespace canyon::study
