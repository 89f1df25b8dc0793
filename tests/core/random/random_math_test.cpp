#include "canyon/core/random/random_math.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::random_math {
namespace {

/// Ten million would be no different; both functions were measured at 3.2e-16 and 1.6e-16.
constexpr std::uint64_t kSamples = 1'000'000;
constexpr double kTolerance = 1e-15;

double relative_error_of_log(double x) {
  const long double exact = std::log(static_cast<long double>(x));
  return exact == 0 ? std::abs(log_positive(x)) : static_cast<double>(std::abs((log_positive(x) - exact) / exact));
}

TEST(RandomMath, LogAgainstTheLibrary) {
  const RandomStream random(3, "test.log");
  double worst = 0.0;
  for (std::uint64_t i = 0; i < kSamples; ++i)
    worst = std::max(worst, relative_error_of_log(1.0 - random.uniform(0, i)));
  // Every binade, at the border of the reduction and where logarithms are small.
  for (int exponent = -60; exponent <= 60; ++exponent) {
    for (const double f : {1.0, 1.0 + 1e-15, 1.4142135623730949, 1.4142135623730951, 1.4142135623730954, 2.0 - 1e-15}) {
      worst = std::max(worst, relative_error_of_log(std::ldexp(f, exponent)));
    }
  }
  for (int k = 1; k <= 53; ++k) worst = std::max(worst, relative_error_of_log(1.0 - std::ldexp(1.0, -k)));
  EXPECT_LT(worst, kTolerance);
  EXPECT_EQ(log_positive(1.0), 0.0);
}

TEST(RandomMath, SineAndCosineAgainstTheLibrary) {
  const RandomStream random(3, "test.sine");
  const long double two_pi = 2 * std::numbers::pi_v<long double>;
  double worst = 0.0;
  const auto try_one = [&](double u) {
    const SineCosine sc = sin_cos_turns(u);
    worst = std::max({worst, std::abs(static_cast<double>(sc.sine - std::sin(two_pi * u))),
                      std::abs(static_cast<double>(sc.cosine - std::cos(two_pi * u)))});
  };
  for (std::uint64_t i = 0; i < kSamples; ++i) try_one(random.uniform(0, i));
  for (int eighth = 0; eighth <= 8; ++eighth) {
    for (const double step : {-0x1p-30, -0x1p-53, 0.0, 0x1p-53, 0x1p-30}) {
      const double u = eighth / 8.0 + step;
      if (u >= 0.0 && u <= 1.0) try_one(u);
    }
  }
  EXPECT_LT(worst, kTolerance);
}

TEST(RandomMath, QuartersAreExact) {
  const double sines[] = {0, 1, 0, -1, 0}, cosines[] = {1, 0, -1, 0, 1};
  for (int quarter = 0; quarter <= 4; ++quarter) {
    EXPECT_EQ(sin_cos_turns(quarter / 4.0).sine, sines[quarter]);
    EXPECT_EQ(sin_cos_turns(quarter / 4.0).cosine, cosines[quarter]);
  }
}

TEST(RandomMath, UniformsAreTheUpper53Bits) {
  EXPECT_EQ(uniform53(0, 0), 0.0);
  EXPECT_EQ(uniform53(0x7FF, 0), 0.0);
  EXPECT_EQ(uniform53(0x800, 0), 0x1p-53);
  EXPECT_EQ(uniform53(0, 0x80000000u), 0.5);
  EXPECT_EQ(uniform53(0xFFFFFFFFu, 0xFFFFFFFFu), 1.0 - 0x1p-53);
  EXPECT_EQ(uniform53(0x89ABCDEFu, 0x01234567u), std::ldexp(static_cast<double>(0x0123456789ABCDEFull >> 11), -53));
}

// Box-Muller never sees zero: the smallest u1 is 2^-53 and the largest radius sqrt(106 ln 2) = 8.57.
TEST(RandomMath, BoxMullerIsSafeAtBothEnds) {
  EXPECT_EQ(uniform53_above_zero(0, 0), 0x1p-53);
  EXPECT_EQ(uniform53_above_zero(0xFFFFFFFFu, 0xFFFFFFFFu), 1.0);
  EXPECT_EQ(box_muller_radius(1.0), 0.0);
  EXPECT_NEAR(box_muller_radius(0x1p-53), std::sqrt(106 * std::numbers::ln2),
              4 * std::numeric_limits<double>::epsilon() * 8.6);
}

}  // namespace
}  // namespace canyon::random_math
