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

TEST(HalfHealed, SmallErrorsThatAreNotHealedDoNotCount) {
  // A drift of registration's own is more than a small error of the estimate.
  EXPECT_DOUBLE_EQ(half({-2.0, 0.75, 0.25}), 10.0 * std::sqrt(10.0));
}

TEST(HalfHealed, NeverAndBeyond) {
  EXPECT_EQ(half({0.4, 0.3, 0.2}), 0.0);
  EXPECT_TRUE(std::isinf(half({0.4, 0.3, 0.6})));
  EXPECT_EQ(half({std::nan(""), 0.1, std::nan("")}), 0.0);
}

}  // namespace
}  // namespace canyon::study
