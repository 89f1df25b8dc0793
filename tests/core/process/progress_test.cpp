#include "canyon/core/process/progress.h"

#include <sys/wait.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/tests/support/temporary_folder.h"

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
    remove_cancel_handler();  // in time: the computation has ended by itself
  }
}

/// A child that has a staged file and never looks at the flag; its exit status after `requests` signals, and how long
/// it lived on.
struct Ended {
  int status = 0;
  double after_s = 0.0;
};
Ended end_of_a_deaf_child(const std::string& path, int requests) {
  std::array<int, 2> ready{};
  EXPECT_EQ(pipe(ready.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    install_cancel_handler();
    auto file = StagedFile::create(path, false);
    auto folder = StagedDirectory::create(path + "-folder/inner", false);
    (void)!::write(ready[1], "!", 1);
    while (file.ok() && folder.ok()) pause();
    _exit(99);
  }
  char byte = 0;
  EXPECT_EQ(::read(ready[0], &byte, 1), 1);
  const auto asked = std::chrono::steady_clock::now();
  for (int k = 0; k < requests; ++k) {
    kill(child, SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  Ended out;
  waitpid(child, &out.status, 0);
  out.after_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
  close(ready[0]);
  close(ready[1]);
  return out;
}

// 2026-11-22: a verb that never looked at the flag went on for minutes after Ctrl-C; a second one was no help.
TEST_F(Cancel, WhatNeverLooksIsLeftBehindAndCleanedUp) {
  const testing::TemporaryFolder folder;
  for (const int requests : {1, 2, 3}) {
    const Ended ended = end_of_a_deaf_child(folder.file("x"), requests);
    ASSERT_TRUE(WIFEXITED(ended.status)) << requests;
    EXPECT_EQ(WEXITSTATUS(ended.status), 130) << requests;
    // One request: 0.6 s of patience. More: at once, where a loaded machine gets its time.
    EXPECT_LT(ended.after_s, 5.0) << requests;
    if (requests == 1) {
      EXPECT_GE(ended.after_s, 0.6);
    }
    if (requests < 3) {
      EXPECT_EQ(folder.entries(), 0) << requests;
    }
  }
}

// 2026-11-22: loops that did not look themselves went on to their end.
TEST_F(Cancel, EveryParallelLoopLooks) {
  for (const int count : {1, 4}) {
    set_threads(count);
    std::atomic<int> done{0};
    set_cancel_requested(false);
    EXPECT_THROW(parallel_for(1000, 1,
                              [&](std::size_t, std::size_t) {
                                if (++done == 10) set_cancel_requested(true);
                              }),
                 Cancelled);
    EXPECT_LE(done.load(), 10 + count);
    set_cancel_requested(false);
  }
  set_threads(0);
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
