#include <string>

#include <gtest/gtest.h>

#include "canyon/apps/line/verb.h"

namespace canyon::apps {
namespace {

// 2026-11-22: warnings gave a terminal whatever bytes a damaged file or its name had.
TEST(Warning, IsOneLineThatATerminalShowsAsItIs) {
  ::testing::internal::CaptureStderr();
  print_warning("log\x1b[31m.csv: \xff\n damaged");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "warning: log\\x1b[31m.csv: \\xff\\x0a damaged\n");
}

}  // namespace
}  // namespace canyon::apps
