#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <set>

#include "canyon/core/process/parallel.h"
#include "canyon/study/stress/cases.h"
#include "canyon/study/stress/run_cases.h"

/// The suite of `canyon stress`: each case a test of its own, the long ones at night.
namespace canyon::study {

void PrintTo(const StressCase& one, std::ostream* out);
void PrintTo(const StressCase& one, std::ostream* out) {
  *out << one.name;
}

namespace {

std::vector<StressCase> cases(bool long_running) {
  std::vector<StressCase> all = all_stress_cases();
  std::erase_if(all, [&](const StressCase& one) { return one.long_running != long_running; });
  return all;
}

std::string test_name(const ::testing::TestParamInfo<StressCase>& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return std::to_string(info.index) + "_" + name;
}

class StressCaseTest : public ::testing::TestWithParam<StressCase> {};
using StressCaseNightly = StressCaseTest;

void expect_holds(const StressCase& one) {
  const CaseResult result = run_case(one);
  if (result.verdict == CaseVerdict::kOpen) {
    std::cout << one.name << " is open: " << one.open << "\n";
    return;
  }
  EXPECT_EQ(result.verdict, CaseVerdict::kHolds)
      << one.name << ": " << result.found.figure << " > " << result.found.bound << " " << one.unit << " "
      << result.thrown << "\nexpected: " << one.expected;
  EXPECT_TRUE(bound_is_tight(result)) << one.name << ": a bound of " << result.found.bound << " says nothing of "
                                      << result.found.figure << ", and the case does not say why";
}

TEST_P(StressCaseTest, Holds) {
  expect_holds(GetParam());
}
TEST_P(StressCaseNightly, Holds) {
  expect_holds(GetParam());
}
INSTANTIATE_TEST_SUITE_P(Stress, StressCaseTest, ::testing::ValuesIn(cases(false)), test_name);
INSTANTIATE_TEST_SUITE_P(Stress, StressCaseNightly, ::testing::ValuesIn(cases(true)), test_name);

TEST(StressCases, HaveNamesOfTheirOwnAndSayWhatTheyAre) {
  std::set<std::string> names;
  for (const StressCase& one : all_stress_cases()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name << " twice";
    EXPECT_NE(one.name.find('/'), std::string::npos) << one.name;
    EXPECT_EQ(one.name.find(' '), std::string::npos) << one.name;
    EXPECT_FALSE(one.mechanism.empty() || one.why.empty() || one.expected.empty()) << one.name;
  }
}

// An issue's floor: as much as this is covered, and no grid counts for more than one way to break.
TEST(StressCases, CoverManyMechanisms) {
  const auto all = all_stress_cases();
  EXPECT_GE(all.size(), 140U);
  EXPECT_GE(mechanisms(all), 45U);
}

/// The figures of each `stride`th case by 1, 2 and 8 threads.
void expect_same_bits_for_any_number_of_threads(std::size_t stride) {
  const auto all = cases(false);
  std::vector<StressFigure> first;
  for (const int count : {1, 2, 8}) {
    set_threads(count);
    for (std::size_t i = 0; i < all.size(); i += stride) {
      const StressFigure found = run_case(all[i]).found;
      if (count == 1) {
        first.push_back(found);
        continue;
      }
      const StressFigure& expected = first[i / stride];
      EXPECT_TRUE(found.figure == expected.figure || (std::isnan(found.figure) && std::isnan(expected.figure)))
          << all[i].name << " with " << count << " threads";
      EXPECT_EQ(found.bound, expected.bound) << all[i].name;
    }
  }
  set_threads(0);
}

TEST(StressCases, GiveTheSameBitsForAnyNumberOfThreads) {
  expect_same_bits_for_any_number_of_threads(5);
}
TEST(StressCasesNightly, GiveTheSameBitsForAnyNumberOfThreads) {
  expect_same_bits_for_any_number_of_threads(1);
}

}  // namespace
}  // namespace canyon::study
