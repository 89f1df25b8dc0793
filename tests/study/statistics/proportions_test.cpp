#include "canyon/study/statistics/proportions.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon::study {
namespace {

// Published values are given to four digits: half of the last one.
constexpr double kFourDigits = 0.5e-4 + 1e-12;

// R. G. Newcombe, Stat. Med. 17 (1998) 857, table I, method 3 (Wilson's score interval).
TEST(WilsonInterval, NewcombesFourExamples) {
  const struct {
    int successes, n;
    double low, high;
  } rows[] = {{81, 263, 0.2553, 0.3662}, {15, 148, 0.0624, 0.1605}, {0, 20, 0.0, 0.1611}, {1, 29, 0.0061, 0.1718}};
  for (const auto& row : rows) {
    const Interval found = wilson_interval(row.successes, row.n);
    EXPECT_NEAR(found.low, row.low, kFourDigits) << row.successes << " of " << row.n;
    EXPECT_NEAR(found.high, row.high, kFourDigits) << row.successes << " of " << row.n;
  }
}

// The interval's ends are the shares from which the found one is just z standard deviations away: Wilson's definition.
TEST(WilsonInterval, EndsSatisfyTheScoreEquation) {
  for (const int n : {1, 7, 20, 400})
    for (int x = 0; x <= n; x += 1 + n / 9) {
      const double share = static_cast<double>(x) / n;
      const Interval found = wilson_interval(x, n);
      // At an end of 0 or 1 the equation holds by both sides being 0.
      for (const double end : {found.low, found.high})
        EXPECT_NEAR(std::abs(share - end), kNormal975 * std::sqrt(end * (1 - end) / n), 1e-12) << x << " of " << n;
    }
}

TEST(WilsonInterval, WithoutTrialsThereIsNone) {
  EXPECT_FALSE(wilson_interval(0, 0).defined());
  EXPECT_EQ(wilson_interval(5, 5).high, 1.0);
  EXPECT_EQ(wilson_interval(0, 5).low, 0.0);
}

// The examples of R. G. Newcombe, Stat. Med. 17 (1998) 2635, for method 10.
TEST(PairedDifference, NewcombesExamples) {
  const struct {
    PairedCounts counts;  // his first is our b: differences are b minus a
    double difference, low, high;
  } rows[] = {{{.both = 36, .only_a = 2, .only_b = 12, .neither = 0}, 0.2, 0.0569, 0.3404},
              {{.both = 18, .only_a = 2, .only_b = 12, .neither = 18}, 0.2, 0.0562, 0.3290},
              {{.both = 53, .only_a = 0, .only_b = 0, .neither = 1}, 0.0, -0.0729, 0.0729}};
  for (const auto& row : rows) {
    EXPECT_DOUBLE_EQ(row.counts.difference(), row.difference);
    EXPECT_NEAR(paired_difference_interval(row.counts).low, row.low, kFourDigits);
    EXPECT_NEAR(paired_difference_interval(row.counts).high, row.high, kFourDigits);
  }
}

// Complete response before and after therapy (Cavo et al. 2012): -0.0621 (-0.1186 to -0.0046) in Fagerland, Lydersen &
// Laake, Statistical Analysis of Contingency Tables (2017), chapter 8: first minus second, ours second minus first.
TEST(PairedDifference, AnotherAuthorsExample) {
  const Interval found = paired_difference_interval({.both = 59, .only_a = 16, .only_b = 6, .neither = 80});
  EXPECT_NEAR(found.low, -0.1186, kFourDigits);
  EXPECT_NEAR(found.high, -0.0046, kFourDigits);
}

TEST(PairedDifference, IsMirroredWhenTheTwoChangePlaces) {
  const PairedCounts counts{.both = 3, .only_a = 8, .only_b = 2, .neither = 7};
  const PairedCounts swapped{.both = 3, .only_a = 2, .only_b = 8, .neither = 7};
  const Interval one = paired_difference_interval(counts), other = paired_difference_interval(swapped);
  EXPECT_EQ(one.low, -other.high);
  EXPECT_EQ(one.high, -other.low);
}

// Where nothing varies the correlation is undefined and counts as none.
TEST(PairedDifference, AllOrNothing) {
  EXPECT_FALSE(paired_difference_interval({}).defined());
  const Interval all = paired_difference_interval({.both = 0, .only_a = 20, .only_b = 0, .neither = 0});
  EXPECT_LT(all.low, -0.7);
  EXPECT_GE(all.low, -1.0);
  const double wilson = wilson_interval(20, 20).low;  // both ends at rest: the two intervals squared and added
  EXPECT_NEAR(all.high, -1.0 + std::hypot(1 - wilson, 1 - wilson), 1e-12);
}

// Airway hyper-responsiveness before and after treatment (Bentur et al. 2009), 1 and 7 discordant pairs: 2 (1 + 8) /
// 2^8.
TEST(McNemar, ExactP) {
  EXPECT_DOUBLE_EQ(mcnemar_exact_p(1, 7), 18.0 / 256.0);
  EXPECT_DOUBLE_EQ(mcnemar_exact_p(7, 1), 18.0 / 256.0);
  EXPECT_DOUBLE_EQ(mcnemar_exact_p(0, 9), 2.0 / 512.0);
  EXPECT_EQ(mcnemar_exact_p(4, 4), 1.0);
  EXPECT_EQ(mcnemar_exact_p(0, 0), 1.0);
}

TEST(FairCoin, SumsOfBinomialCoefficients) {
  // 1 + 20 + 190 + 1140 + 4845 + 15504 of 2^20.
  EXPECT_DOUBLE_EQ(fair_coin_tail(5, 20), 21700.0 / 1048576.0);
  EXPECT_DOUBLE_EQ(fair_coin_tail(2, 3), 7.0 / 8.0);
  EXPECT_EQ(fair_coin_tail(-1, 3), 0.0);
  EXPECT_EQ(fair_coin_tail(3, 3), 1.0);
  // Of 10^6 tosses 2^-n is no number any more. Half, and half of the middle term sqrt(2 / (pi n)) (1 + O(1 / n)).
  EXPECT_NEAR(fair_coin_tail(500'000, 1'000'000), 0.5 + 0.5 * std::sqrt(2 / (M_PI * 1e6)), 1e-9);
}

}  // namespace
}  // namespace canyon::study
