#include "canyon/mission/motion/schedule.h"

#include <vector>

#include <gtest/gtest.h>

namespace canyon::mission {
namespace {

constexpr GpsTime kScheduleStart{123'456'789'000'000'000};

std::vector<Due> all(Schedule& schedule, double until_s) {
  std::vector<Due> out;
  while (const auto due = schedule.next(kScheduleStart + until_s)) out.push_back(*due);
  return out;
}

TEST(Schedule, EachTaskAtItsOwnTicksInOrder) {
  Schedule schedule(kScheduleStart, {25.0, 3.0, 10.0, 100.0, 7.0});
  const auto due = all(schedule, 1.0);
  std::vector<std::int64_t> count(5, 0);
  for (std::size_t i = 0; i < due.size(); ++i) {
    const auto task = static_cast<std::size_t>(due[i].task);
    EXPECT_EQ(due[i].k, ++count[task]);
    constexpr double kRates[] = {25.0, 3.0, 10.0, 100.0, 7.0};
    EXPECT_EQ(due[i].t, tick(kScheduleStart, due[i].k, kRates[task]));
    if (i == 0) continue;
    EXPECT_TRUE(due[i - 1].t < due[i].t || (due[i - 1].t == due[i].t && due[i - 1].task < due[i].task));
  }
  EXPECT_EQ(count, (std::vector<std::int64_t>{25, 3, 10, 100, 7}));
  EXPECT_FALSE(schedule.next(kScheduleStart + 1.0).has_value());
}

// What is due does not depend on how the time is cut into steps.
TEST(Schedule, StepsDoNotMatter) {
  Schedule whole(kScheduleStart, {128.0, 5.0, 7.3, 50.0, 10.0}), stepped(whole);
  const auto expected = all(whole, 2.0);
  std::vector<Due> got;
  for (int k = 1; k <= 200; ++k)
    for (const Due& due : all(stepped, 0.01 * k)) got.push_back(due);
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].t, expected[i].t);
    EXPECT_EQ(got[i].task, expected[i].task);
  }
}

}  // namespace
}  // namespace canyon::mission
