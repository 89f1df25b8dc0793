#pragma once

#include <cctype>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/stress_case.h"

/// The stiff and extreme cases of one floor as tests: CANYON_STRESS_TESTS(Core, canyon::stress_cases()).
namespace canyon::testing {

inline std::string test_name_of(const StressCase& c) {
  std::string name;
  for (const char x : c.name) name += std::isalnum(static_cast<unsigned char>(x)) ? x : x == '-' ? 'm' : '_';
  return name;
}

inline void expect_holds(const StressCase& c) {
  const StressFigure found = c.run();
  ::testing::Test::RecordProperty("figure", std::to_string(found.figure));
  if (!c.open.empty()) GTEST_SKIP() << "open: " << c.open << ": " << found.figure << ", bound " << found.bound;
  EXPECT_TRUE(std::isfinite(found.figure) && found.figure <= found.bound)
      << c.name << ": " << found.figure << " " << c.unit << ", bound " << found.bound << "; " << c.expected;
  if (found.figure > 0.0 && c.loose.empty())
    EXPECT_LE(found.bound, 1000.0 * found.figure) << c.name << ": a bound that loose needs its reason";
}

inline void expect_described(const std::vector<StressCase>& cases) {
  std::set<std::string> names;
  for (const StressCase& c : cases) {
    EXPECT_TRUE(names.insert(test_name_of(c)).second) << c.name;
    EXPECT_FALSE(c.mechanism.empty() || c.why.empty() || c.expected.empty()) << c.name;
    EXPECT_EQ(c.name.find(' '), std::string::npos) << c.name;
  }
}

inline std::vector<StressCase> of_length(std::vector<StressCase> cases, bool long_running) {
  std::erase_if(cases, [&](const StressCase& c) { return c.long_running != long_running; });
  return cases;
}

}  // namespace canyon::testing

#define CANYON_STRESS_TESTS(Floor, cases)                                                                            \
  class Floor##Stress : public ::testing::TestWithParam<canyon::StressCase> {};                                      \
  TEST_P(Floor##Stress, Holds) {                                                                                     \
    canyon::testing::expect_holds(GetParam());                                                                       \
  }                                                                                                                  \
  INSTANTIATE_TEST_SUITE_P(Short, Floor##Stress, ::testing::ValuesIn(canyon::testing::of_length(cases, false)),      \
                           [](const auto& info) { return canyon::testing::test_name_of(info.param); });              \
  INSTANTIATE_TEST_SUITE_P(LongNightly, Floor##Stress, ::testing::ValuesIn(canyon::testing::of_length(cases, true)), \
                           [](const auto& info) { return canyon::testing::test_name_of(info.param); });              \
  TEST(Floor##StressTable, IsDescribed) {                                                                            \
    canyon::testing::expect_described(cases);                                                                        \
  }
