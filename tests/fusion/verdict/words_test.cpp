// Numbers in, words out: each line word for word.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/fusion/verdict/verdict.h"

namespace canyon::fusion {
namespace {

using ::testing::ElementsAre;

constexpr Band kBand{.low = 0.8, .high = 1.25};

SquareMean squares(double value) {
  return {.value = value, .samples = 400, .effective = 100, .band = kBand};
}

AxisNumbers height(double rms_m, double claimed_m, double ratio) {
  return {
      .block = "height", .name = "height", .unit = "m", .rms = rms_m, .claimed = claimed_m, .ratio = squares(ratio)};
}

MeasurementNumbers measurement(const char* name, double nis) {
  MeasurementNumbers out;
  out.name = name;
  out.count = 400;
  out.nis = squares(nis);
  return out;
}

Whiteness lasting(double at_lag_one, double correlation_s) {
  return {
      .at_lag_one = at_lag_one, .statistic = 90, .threshold = 40, .correlation_s = correlation_s, .interval_s = 0.5};
}

StateNumbers state(const char* block, const char* name, bool observed) {
  StateNumbers out{.block = block, .name = name, .share = observed ? 0.1 : 0.9, .least_share = observed ? 0.1 : 0.9};
  if (observed) out.halved_after_s = 12.0;
  return out;
}

TEST(VerdictWords, NothingIsSaidWhereNothingIsWrong) {
  VerdictNumbers numbers;
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("consistent"));
  numbers.axes = {height(2.1, 2.0, 1.1)};
  numbers.blocks = {{.name = "height", .nees = squares(1.1)}};
  numbers.measurements = {measurement("position", 0.9)};
  numbers.processes = {{.name = "wheel_scale", .ratio = squares(0.81)}};
  numbers.fixes = FixNumbers{.rms_m = 3.0, .claimed_m = 3.0, .ratio = squares(1.0)};
  numbers.states = {state("mounting", "mounting x", true)};
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("consistent"));
}

TEST(VerdictWords, WhatIsSignificantButSmallIsNotSaid) {
  VerdictNumbers numbers;
  numbers.axes = {height(2.1, 2.0, 1.1)};
  numbers.axes[0].ratio.band = {.low = 0.99, .high = 1.01};
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("consistent"));
}

TEST(VerdictWords, ErrorsBesideWhatIsClaimed) {
  VerdictNumbers numbers;
  numbers.axes = {height(4.6, 2.0, 2.3 * 2.3)};
  numbers.blocks = {{.name = "height", .nees = squares(2.3 * 2.3)}};
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("height overconfident by 2.3 (error 4.6 m where 2 m are claimed)"));
}

TEST(VerdictWords, ABlockSpeaksWhereNoAxisDoes) {
  VerdictNumbers numbers;
  numbers.blocks = {{.name = "position", .nees = squares(4.2)}};
  EXPECT_THAT(verdict_lines(numbers),
              ElementsAre("position: errors and covariance do not fit together (NEES 4.2 per axis)"));
}

TEST(VerdictWords, Innovations) {
  VerdictNumbers numbers;
  numbers.measurements = {measurement("odometer", 3.1 * 3.1)};
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("odometer: innovations 3.1 times too large"));
  numbers.measurements[0].nis = squares(0.25);
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("odometer: innovations 2.0 times too small"));
  numbers.measurements[0] = measurement("position", 1.0);
  numbers.measurements[0].white = lasting(0.62, 4.2);
  EXPECT_THAT(verdict_lines(numbers),
              ElementsAre("position: innovations correlated over 4.2 s (0.62 from one to the next)"));
  numbers.measurements[0].white = lasting(-0.4, 0.0);
  EXPECT_THAT(verdict_lines(numbers),
              ElementsAre("position: innovations not independent (-0.40 from one to the next)"));
  numbers.measurements[0] = measurement("position", 1.0);
  numbers.measurements[0].refused = 48;
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("position: 48 of 400 refused"));
}

TEST(VerdictWords, Fixes) {
  VerdictNumbers numbers;
  numbers.fixes = FixNumbers{.rms_m = 6.0, .claimed_m = 2.0, .ratio = squares(9.0), .white = lasting(0.9, 8.0)};
  EXPECT_THAT(verdict_lines(numbers),
              ElementsAre("fixes correlated over 8 s, the filter takes them as independent",
                          "fixes 3.0 times worse than they say (error 6 m where 2 m are claimed)"));
  numbers.fixes->lasting_is_modelled = true;
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("consistent"));
}

TEST(VerdictWords, ProcessesOfStates) {
  VerdictNumbers numbers;
  numbers.processes = {{.name = "gyro turn-on bias", .ratio = squares(9.0)}};
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("gyro turn-on bias: 3.0 times larger than its 1-sigma lets expect"));
}

TEST(VerdictWords, WhatIsNotObservedIsNoFault) {
  VerdictNumbers numbers;
  numbers.states = {state("mounting", "mounting x", false), state("mounting", "mounting y", true),
                    state("mounting", "mounting z", true), state("hard_iron", "hard_iron x", false),
                    state("wheel_scale", "wheel_scale", true)};
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("consistent", "mounting x not observed", "hard_iron not observed"));
  for (int i = 0; i < 6; ++i) numbers.states.push_back(state("gains", "gain", i < 2));
  EXPECT_THAT(verdict_lines(numbers), ElementsAre("consistent", "mounting x not observed", "hard_iron not observed",
                                                  "gains: 4 of 6 not observed"));
}

TEST(VerdictWords, TheWorstComesFirst) {
  VerdictNumbers numbers;
  numbers.axes = {height(4.6, 2.0, 2.3 * 2.3)};
  numbers.measurements = {measurement("odometer", 3.1 * 3.1), measurement("barometer", 0.0625)};
  numbers.states = {state("mounting", "mounting", false)};
  EXPECT_THAT(verdict_lines(numbers),
              ElementsAre("barometer: innovations 4.0 times too small", "odometer: innovations 3.1 times too large",
                          "height overconfident by 2.3 (error 4.6 m where 2 m are claimed)", "mounting not observed"));
}

}  // namespace
}  // namespace canyon::fusion
