#include "canyon/core/process/awake_time.h"

#include <gtest/gtest.h>

namespace canyon {
namespace {

using namespace std::chrono_literals;

TEST(AwakeTime, WhatPassesWhileNobodyLooksCountsForOneGap) {
  AwakeTime time(500ms);
  AwakeTime::Clock::time_point now{1h};
  EXPECT_EQ(time.look(now), 0ms) << "it begins with the first look";
  for (int i = 0; i < 20; ++i) time.look(now += 50ms);
  EXPECT_EQ(time.look(now), 1s);
  EXPECT_EQ(time.look(now += 1h), 1500ms) << "stopped for an hour";
  EXPECT_EQ(time.look(now += 50ms), 1550ms);
}

TEST(AwakeTime, NeverGoesBack) {
  AwakeTime time(500ms);
  const AwakeTime::Clock::time_point now{1h};
  time.look(now);
  EXPECT_EQ(time.look(now + 100ms), 100ms);
  EXPECT_EQ(time.look(now + 50ms), 100ms) << "read before the other, looked after it";
  EXPECT_EQ(time.look(now + 150ms), 150ms);
}

}  // namespace
}  // namespace canyon
