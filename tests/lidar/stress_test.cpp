#include "canyon/lidar/stress/stress_cases.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace canyon::lidar {
namespace {

class LidarStress : public ::testing::TestWithParam<StressCase> {};

std::string test_name(const ::testing::TestParamInfo<StressCase>& info) {
  std::string name;
  for (const char c : info.param.name) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

std::vector<StressCase> short_cases() {
  std::vector<StressCase> out;
  for (StressCase& one : stress_cases())
    if (!one.long_running) out.push_back(std::move(one));
  return out;
}

TEST_P(LidarStress, Holds) {
  const StressCase& one = GetParam();
  const StressFigure got = one.run();
  RecordProperty("figure", std::to_string(got.figure));
  if (!one.open.empty()) GTEST_SKIP() << one.open;
  ASSERT_TRUE(std::isfinite(got.figure)) << one.expected;
  EXPECT_LE(got.figure, got.bound) << one.expected;
  if (got.figure != 0.0 && one.loose.empty()) EXPECT_LE(got.bound, 1000.0 * got.figure) << "a bound that is too loose";
}

INSTANTIATE_TEST_SUITE_P(Cases, LidarStress, ::testing::ValuesIn(short_cases()), test_name);

TEST(LidarStressTable, IsComplete) {
  std::set<std::string> names, tests;
  for (const StressCase& one : stress_cases()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_TRUE(tests.insert(test_name({one, 0})).second) << one.name;
    EXPECT_EQ(one.name.find(' '), std::string::npos) << one.name;
    for (const std::string* text : {&one.mechanism, &one.why, &one.expected}) EXPECT_FALSE(text->empty()) << one.name;
  }
}

}  // namespace
}  // namespace canyon::lidar
