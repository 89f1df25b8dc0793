#include "canyon/core/check.h"

#include <gtest/gtest.h>

namespace canyon {
namespace {

TEST(Check, PassesSilentlyAndEvaluatesOnce) {
  int calls = 0;
  CANYON_CHECK(++calls == 1);
  EXPECT_EQ(calls, 1);
}

TEST(Check, FailureCarriesConditionPlaceAndValues) {
  const double rate_hz = -0.1;
  int line = 0;
  try {
    line = __LINE__ + 1;
    CANYON_CHECK(rate_hz > 0, "rate_hz = ", rate_hz);
    FAIL() << "no exception";
  } catch (const ProgramError& e) {
    EXPECT_EQ(std::string(e.what()), "core/check_test.cpp:" + std::to_string(line) +
                                         ": check failed: rate_hz > 0 (rate_hz = -0.10000000000000001)");
  }
}

TEST(Check, WithoutValuesThereAreNoBrackets) {
  try {
    CANYON_CHECK(1 > 2);
    FAIL() << "no exception";
  } catch (const ProgramError& e) {
    EXPECT_TRUE(std::string(e.what()).ends_with(": check failed: 1 > 2")) << e.what();
  }
}

}  // namespace
}  // namespace canyon
