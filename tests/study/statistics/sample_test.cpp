#include "canyon/study/statistics/sample.h"

#include <numeric>

#include <gtest/gtest.h>

#include "canyon/study/statistics/batch_means.h"

namespace canyon::study {
namespace {

std::vector<double> one_to(int n) {
  std::vector<double> values(static_cast<std::size_t>(n));
  std::iota(values.rbegin(), values.rend(), 1.0);  // descending: the order must not matter
  return values;
}

// Ranks of the 95 % interval of the median, as tabulated (Hahn & Meeker, Statistical Intervals, table A.16 a; Conover,
// Practical Nonparametric Statistics, table A3).
TEST(MedianInterval, TabulatedRanks) {
  const struct {
    int n;
    double low, high;
  } rows[] = {{6, 1, 6}, {9, 2, 8}, {10, 2, 9}, {15, 4, 12}, {20, 6, 15}, {30, 10, 21}, {50, 18, 33}};
  for (const auto& row : rows) {
    const Interval found = median_interval(one_to(row.n));
    EXPECT_EQ(found.low, row.low) << row.n;
    EXPECT_EQ(found.high, row.high) << row.n;
  }
  EXPECT_FALSE(median_interval(one_to(5)).defined()) << "even smallest to largest holds it with 94 % only";
}

// 1, 2, 3: mean 2, standard deviation 1, t(2) = 4.303.
TEST(MeanInterval, ByHand) {
  const Interval found = mean_interval({3.0, 1.0, 2.0});
  EXPECT_NEAR(found.low, 2 - 4.30265 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(found.high, 2 + 4.30265 / std::sqrt(3.0), 1e-12);
  EXPECT_FALSE(mean_interval({1.0}).defined());
  EXPECT_TRUE(std::isnan(mean({})));
}

// Student's t, 97.5 %: as in every table, to its last digit where the expansion is (0.0005), 1 % at 3 degrees.
TEST(Student, TabulatedQuantiles) {
  EXPECT_NEAR(student_975(3), 3.182, 0.01 * 3.182);
  EXPECT_NEAR(student_975(10), 2.228, 0.0005);
  EXPECT_NEAR(student_975(19), 2.093, 0.0005);
  EXPECT_NEAR(student_975(120), 1.980, 0.0005);
}

// Three batches of 30 s with means 1, 2, 6, samples every 10 s; what is left over after 90 s belongs to the last.
TEST(BatchMeans, ByHand) {
  BatchMeans batches;
  for (int k = 0; k < 9; ++k) batches.add(100.0 + 10.0 * k, k < 3 ? 1.0 : k < 6 ? 2.0 : 6.0);
  EXPECT_FALSE(BatchMeans().interval().defined());
  batches.add(190.0, 6.0);
  EXPECT_EQ(batches.samples(), 10);
  EXPECT_DOUBLE_EQ(batches.mean(), (3 * 1.0 + 3 * 2.0 + 4 * 6.0) / 10);
  const double m = batches.mean();
  const double sigma = std::sqrt(((1 - m) * (1 - m) + (2 - m) * (2 - m) + (6 - m) * (6 - m)) / 2 / 3);
  EXPECT_NEAR(batches.interval().low, m - 4.30265 * sigma, 1e-12);
  EXPECT_NEAR(batches.interval().high, m + 4.30265 * sigma, 1e-12);
}

TEST(BatchMeans, LessThanAMinuteHasNoInterval) {
  BatchMeans batches;
  for (int k = 0; k < 60; ++k) batches.add(k, k);
  EXPECT_FALSE(batches.interval().defined());
  EXPECT_DOUBLE_EQ(batches.mean(), 29.5);
}

}  // namespace
}  // namespace canyon::study
