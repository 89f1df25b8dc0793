// What is wrong in a filter's parameters and can be seen is named; what is right is not.
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/tests/fusion/verdict/matched_verdict.h"

namespace canyon::fusion {
namespace {

using testing::WrongParameter;

constexpr double kTooLarge = 3.0, kTooSmall = 1.0 / 3.0;

/// One way of being wrong, and whether 100 s of these sensors show it (docs/fusion.md has the list).
struct Wrong {
  const char* parameter;
  double factor;
  bool observable;
};
constexpr Wrong kWrong[] = {
    {"noise of the fixes' positions", kTooLarge, true},
    {"noise of the fixes' positions", kTooSmall, true},
    {"noise of the fixes' velocities", kTooLarge, true},
    {"noise of the fixes' velocities", kTooSmall, true},
    {"white noise of the gyroscopes", kTooLarge, false},
    {"white noise of the gyroscopes", kTooSmall, false},
    {"white noise of the accelerometers", kTooLarge, false},
    {"white noise of the accelerometers", kTooSmall, false},
    {"sigma of the biases", kTooLarge, false},
    {"sigma of the biases", kTooSmall, false},
    {"noise of the odometer", kTooLarge, true},
    {"noise of the odometer", kTooSmall, true},
    {"sigma of the wheel's scale", kTooLarge, false},
    {"sigma of the wheel's scale", kTooSmall, false},
    {"sigma of the fixes' lasting error", kTooLarge, true},
    {"sigma of the fixes' lasting error", kTooSmall, true},
    {"correlation time of the fixes' lasting error", kTooLarge, true},
    {"correlation time of the fixes' lasting error", kTooSmall, true},
    {"noise of the barometer", kTooLarge, true},
    {"noise of the barometer", kTooSmall, true},
    {"noise of the magnetometer", kTooLarge, true},
    {"noise of the magnetometer", kTooSmall, true},
};

const WrongParameter& parameter(const std::string& name) {
  static const std::vector<WrongParameter> all = testing::wrong_parameters();
  for (const WrongParameter& wrong : all)
    if (wrong.name == name) return wrong;
  throw std::runtime_error(name);
}

/// Worlds from `first` on in which the filter's verdict names what is wrong.
int named(const Wrong& wrong, int first, int runs) {
  int out = 0;
  for (int i = 0; i < runs; ++i) {
    const WrongParameter& what = parameter(wrong.parameter);
    out += testing::names(testing::faults_of_run(static_cast<std::uint64_t>(first + i), &what, wrong.factor), what);
  }
  std::printf("%-46s told x %.2f: named in %d of %d runs\n", wrong.parameter, wrong.factor, out, runs);
  return out;
}

int faulted(int first, int runs) {
  int out = 0;
  for (int i = 0; i < runs; ++i) {
    const auto faults = testing::faults_of_run(static_cast<std::uint64_t>(first + i), nullptr, 1.0);
    for (const std::string& subject : faults) std::printf("matched, world %d: %s\n", first + i, subject.c_str());
    out += faults.empty() ? 0 : 1;
  }
  std::printf("matched: fault found with %d of %d runs\n", out, runs);
  return out;
}

TEST(WrongParameter, IsNamedAndNothingElseIs) {
  EXPECT_EQ(faulted(201, 5), 0);
  for (const Wrong& wrong : kWrong) {
    if (!wrong.observable) continue;
    EXPECT_EQ(named(wrong, 201, 1), 1) << wrong.parameter << " x " << wrong.factor;
  }
}

// The worlds are not those by which the tests were chosen (1001 and on).
TEST(WrongParameter, NightlyIsNamedWhereItIsObservable) {
  constexpr int kRuns = 20;
  for (const Wrong& wrong : kWrong) {
    const int times = named(wrong, 1, kRuns);
    if (wrong.observable)
      EXPECT_GE(times, 19) << wrong.parameter << " x " << wrong.factor;  // 95 %
    else
      EXPECT_LT(times, 19) << wrong.parameter << " x " << wrong.factor
                           << " is observable, and the list does not say so";
  }
}

TEST(WrongParameter, NightlyMatchedModelsAreFoundNoFaultWith) {
  EXPECT_LE(faulted(1, 100), 5);  // at most 5 %; by the tests' own false alarm one is expected
}

}  // namespace
}  // namespace canyon::fusion
