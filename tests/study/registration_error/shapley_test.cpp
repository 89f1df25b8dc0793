#include "canyon/study/registration_error/shapley.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

ShapleyShares shares(std::size_t players, std::size_t orders, const std::function<double(Coalition)>& value,
                     std::uint64_t seed = 1) {
  const auto drawn = sampled_orders(players, orders, seed);
  const auto coalitions = coalitions_of(drawn, players);
  std::vector<double> values;
  for (const Coalition c : coalitions) values.push_back(value(c));
  return shapley_shares(drawn, players, coalitions, values);
}

/// A linear system with Gaussian sources: the error is the sum of a_i x_i, its mean square the quadratic form of their
/// covariance C; source i's Shapley value is a_i (C a)_i, each pair's covariance shared evenly.
TEST(Shapley, LinearGaussianMatchesItsClosedForm) {
  constexpr std::size_t kSources = 9;
  const RandomStream random(3, "test.linear");
  double L[kSources][kSources], C[kSources][kSources] = {}, a[kSources];
  for (std::size_t i = 0; i < kSources; ++i) {
    a[i] = random.uniform(-2, 2, 100, i);
    for (std::size_t j = 0; j < kSources; ++j) L[i][j] = random.normal(static_cast<std::uint32_t>(i), j);
  }
  for (std::size_t i = 0; i < kSources; ++i)
    for (std::size_t j = 0; j < kSources; ++j)
      for (std::size_t k = 0; k < kSources; ++k) C[i][j] += L[i][k] * L[j][k];
  constexpr double kFloor = 0.7;
  const auto mean_square = [&](Coalition c) {
    double sum = kFloor;
    for (std::size_t i = 0; i < kSources; ++i)
      for (std::size_t j = 0; j < kSources; ++j)
        if ((c >> i & 1u) != 0 && (c >> j & 1u) != 0) sum += a[i] * C[i][j] * a[j];
    return sum;
  };
  const ShapleyShares s = shares(kSources, 8, mean_square);
  EXPECT_EQ(s.floor, kFloor);
  double sum = 0.0;
  for (std::size_t i = 0; i < kSources; ++i) {
    double expected = 0.0;
    for (std::size_t j = 0; j < kSources; ++j) expected += a[i] * C[i][j] * a[j];
    EXPECT_NEAR(s.share[i], expected, 1e-12 * s.total) << "rounding of sums of 81 terms";
    EXPECT_LT(s.order_sigma[i], 1e-12 * s.total) << "a pair of orders is exact";
    sum += s.share[i];
  }
  EXPECT_NEAR(sum, s.total - s.floor, 1e-12 * s.total);
}

/// The same where the mean square is that of samples, as a run's is.
TEST(Shapley, LinearSystemOfSamples) {
  constexpr std::size_t kSources = 5, kSamples = 400;
  const RandomStream random(5, "test.samples");
  std::vector<std::vector<double>> part(kSources);
  for (std::size_t i = 0; i < kSources; ++i)
    for (std::size_t k = 0; k < kSamples; ++k)
      part[i].push_back(0.3 * static_cast<double>(i) * random.normal(static_cast<std::uint32_t>(i), k));
  const auto mean_square = [&](Coalition c) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kSamples; ++k) {
      double error = 0.0;
      for (std::size_t i = 0; i < kSources; ++i) error += (c >> i & 1u) != 0 ? part[i][k] : 0.0;
      sum += error * error / kSamples;
    }
    return sum;
  };
  const ShapleyShares s = shares(kSources, 2, mean_square);
  EXPECT_EQ(s.share[0], 0.0) << "a source that is switched off";
  for (std::size_t i = 0; i < kSources; ++i) {
    double expected = 0.0;
    for (std::size_t k = 0; k < kSamples; ++k)
      for (std::size_t j = 0; j < kSources; ++j) expected += part[i][k] * part[j][k] / kSamples;
    EXPECT_NEAR(s.share[i], expected, 1e-12 * s.total);
    EXPECT_TRUE(std::isnan(s.order_sigma[i])) << "one pair of orders says nothing of further ones";
  }
}

/// Where three act together orders are samples: the error is within what it says, 4 sigma (6e-5), and the sum exact.
TEST(Shapley, SampledOrdersSayTheirOwnError) {
  constexpr std::size_t kPlayers = 6;
  const auto together = [](Coalition c) {  // worth 1 where players 0, 1 and 2 are there; 1/3 each
    return (c & 7u) == 7u ? 1.0 : 0.0;
  };
  const ShapleyShares s = shares(kPlayers, 200, together, 11);
  for (std::size_t i = 0; i < kPlayers; ++i)
    EXPECT_NEAR(s.share[i], i < 3 ? 1.0 / 3.0 : 0.0, 4 * s.order_sigma[i] + 1e-15);
  EXPECT_GT(s.order_sigma[0], 0.0);
  EXPECT_EQ(s.share[4], 0.0);
}

TEST(Shapley, OrdersComeInPairsAndAreThoseOfTheirSeed) {
  const auto orders = sampled_orders(7, 5, 2);
  ASSERT_EQ(orders.size(), 6U) << "rounded up";
  for (std::size_t k = 0; k < orders.size(); k += 2)
    EXPECT_TRUE(std::equal(orders[k].begin(), orders[k].end(), orders[k + 1].rbegin()));
  EXPECT_EQ(orders, sampled_orders(7, 5, 2));
  EXPECT_NE(orders, sampled_orders(7, 5, 3));
  // Every player is first about as often: 600 pairs, binomial, 4 sigma.
  std::vector<int> first(6);
  const auto many = sampled_orders(6, 1200, 9);
  for (std::size_t k = 0; k < many.size(); k += 2) ++first[many[k].front()];
  for (const int n : first) EXPECT_NEAR(n, 100, 4 * std::sqrt(600 * 5.0 / 36));
  EXPECT_EQ(coalitions_of(sampled_orders(0, 2, 1), 0), std::vector<Coalition>{0}) << "nobody acts";
}

}  // namespace
}  // namespace canyon::study
