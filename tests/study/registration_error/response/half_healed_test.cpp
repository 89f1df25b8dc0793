#include "canyon/study/registration_error/response/half_healed.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace canyon::study {
namespace {

double half(const std::vector<double>& healed) {
  const std::vector<double> sizes{1.0, 10.0, 100.0};
  return half_healed_size(sizes, healed);
}

TEST(HalfHealed, LiesBetweenTheTwoSizesByTheLogarithm) {
  EXPECT_DOUBLE_EQ(half({0.9, 0.75, 0.25}), 10.0 * std::sqrt(10.0));
  EXPECT_DOUBLE_EQ(half({0.9, 0.5, 0.25}), 10.0);
  EXPECT_DOUBLE_EQ(half({0.7, -0.1, -3.0}), std::pow(10.0, 0.25));
}

// 2026-11-30: of 0.134 at 0.5 m and 0.512 at 2 m it was said to be half "beyond", and what is not healed of a small
// error was left out.
TEST(HalfHealed, EndsWhereItFallsBelowHalfFirst) {
  EXPECT_EQ(half_healed_size(std::vector{0.5, 2.0}, std::vector{0.134, 0.512}), 0.0);
  EXPECT_EQ(half({-2.0, 0.75, 0.25}), 0.0);
  EXPECT_DOUBLE_EQ(half({0.9, 0.1, 0.75}), std::sqrt(10.0)) << "what is healed of larger ones again does not count";
  EXPECT_DOUBLE_EQ(half({0.9, std::nan(""), 0.75}), std::pow(10.0, 0.4 / 0.9)) << "as if nothing were";
}

TEST(HalfHealed, BelowAndBeyondWhatWasTried) {
  EXPECT_EQ(half({0.4, 0.3, 0.2}), 0.0);
  EXPECT_EQ(half({0.4, 0.3, 0.6}), 0.0);
  EXPECT_TRUE(std::isinf(half({0.5, 0.9, 0.6})));
  EXPECT_EQ(half({std::nan(""), 0.1, std::nan("")}), 0.0);
}

}  // namespace
}  // namespace canyon::study
