#include "core/progress.h"

#include <csignal>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace canyon {
namespace {

class Cancel : public ::testing::Test {
 protected:
  ~Cancel() override { set_cancel_requested(false); }
};

TEST_F(Cancel, FlagThrows) {
  set_cancel_requested(false);
  EXPECT_NO_THROW(throw_if_cancelled());
  set_cancel_requested(true);
  EXPECT_TRUE(cancel_requested());
  EXPECT_THROW(throw_if_cancelled(), Cancelled);
}

TEST_F(Cancel, SignalsOnlySetTheFlag) {
  for (const int signal : {SIGINT, SIGTERM}) {
    set_cancel_requested(false);
    install_cancel_handler();
    std::raise(signal);
    EXPECT_TRUE(cancel_requested());
    std::raise(signal);  // a second one does not kill either
    EXPECT_TRUE(cancel_requested());
    std::signal(signal, SIG_DFL);
  }
}

TEST(Progress, WritesNothingWhenStderrIsNoTerminal) {
  ::testing::internal::CaptureStderr();  // a file
  {
    Progress progress("scans", 100.0);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 25; ++i) progress.advance(1.0);
      });
    }
    for (std::thread& t : threads) t.join();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace canyon
