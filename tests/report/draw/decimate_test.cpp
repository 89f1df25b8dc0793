#include "canyon/report/draw/decimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::report {
namespace {

std::vector<double> ramp(std::size_t n) {
  std::vector<double> x(n);
  std::iota(x.begin(), x.end(), 0.0);
  return x;
}

TEST(Decimate, ShortSeriesStayWhole) {
  const std::vector<double> x = ramp(40), y = x;
  const auto pieces = decimate(x, y, 10);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].size(), 40u);
}

TEST(Decimate, KeepsEveryBucketsExtremes) {
  constexpr std::size_t kSamples = 100'000, kBuckets = 100;
  const std::vector<double> x = ramp(kSamples);
  std::vector<double> y(kSamples);
  RandomStream(1, "test.decimate").fill_normal(y, 0, 0);
  y[31'415] = 1e6;  // one spike among a hundred thousand
  const auto pieces = decimate(x, y, kBuckets);
  ASSERT_EQ(pieces.size(), 1u);
  const LinePiece& kept = pieces[0];
  EXPECT_LE(kept.size(), 4 * kBuckets);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(std::adjacent_find(kept.begin(), kept.end()), kept.end());
  EXPECT_EQ(kept.front(), 0u);
  EXPECT_EQ(kept.back(), kSamples - 1);
  for (std::size_t b = 0; b < kBuckets; ++b) {
    double low = INFINITY, high = -INFINITY, kept_low = INFINITY, kept_high = -INFINITY;
    const auto in_bucket = [&](std::size_t i) {
      return std::min(static_cast<std::size_t>(x[i] / x.back() * kBuckets), kBuckets - 1) == b;
    };
    for (std::size_t i = 0; i < kSamples; ++i) {
      if (in_bucket(i)) low = std::min(low, y[i]), high = std::max(high, y[i]);
    }
    for (const std::size_t i : kept) {
      if (in_bucket(i)) kept_low = std::min(kept_low, y[i]), kept_high = std::max(kept_high, y[i]);
    }
    EXPECT_EQ(kept_low, low) << b;
    EXPECT_EQ(kept_high, high) << b;
  }
}

TEST(Decimate, GapsCutTheLine) {
  const std::vector<double> x = ramp(7);
  const std::vector<double> y{NAN, 1, 2, NAN, NAN, 3, NAN};
  const auto pieces = decimate(x, y, 100);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0], (LinePiece{1, 2}));
  EXPECT_EQ(pieces[1], (LinePiece{5}));
}

TEST(Decimate, AGapWiderThanABucketCutsAlsoALongSeries) {
  constexpr std::size_t kSamples = 10'000;
  const std::vector<double> x = ramp(kSamples);
  std::vector<double> y(kSamples, 1.0);
  std::fill(y.begin() + 3000, y.begin() + 3500, NAN);
  y[7777] = NAN;  // narrower than a bucket of 100: drawn through
  const auto pieces = decimate(x, y, 100);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].back(), 2999u);
  EXPECT_EQ(pieces[1].front(), 3500u);
}

TEST(Decimate, NothingGivesNothing) {
  EXPECT_TRUE(decimate({}, {}, 10).empty());
  const std::vector<double> x{1, 2}, y{NAN, NAN};
  EXPECT_TRUE(decimate(x, y, 10).empty());
}

TEST(Decimate, EqualTimesAreAllowed) {
  const std::vector<double> x(1000, 5.0), y(1000, 2.0);
  EXPECT_EQ(decimate(x, y, 10).size(), 1u);
}

}  // namespace
}  // namespace canyon::report
