#include "canyon/core/process/cpu_time.h"

#include <cmath>
#include <ctime>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"

namespace canyon {
namespace {

/// Computes until the calling thread has spent that long.
void burn(double seconds) {
  const auto now_s = [] {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  const double end_s = now_s() + seconds;
  volatile double x = 1.0;
  while (now_s() < end_s)
    for (int i = 0; i < 1000; ++i) x = std::sqrt(x + 1.0);
}

class CpuTime : public ::testing::Test {
 protected:
  ~CpuTime() override { set_threads(0); }
};

// Between reading the clock and the end of a charge lie microseconds: 2 ms leave room for a thread that is set aside.
constexpr double kSlack_s = 2e-3;

TEST_F(CpuTime, OfChargesInsideOneAnotherTheInnermostCounts) {
  CpuAccount outer, inner;
  {
    const ChargeCpu charge_outer(&outer);
    burn(0.01);
    {
      const ChargeCpu charge_inner(&inner);
      burn(0.03);
      const ChargeCpu nobody(nullptr);
      burn(0.02);
    }
    burn(0.01);
    EXPECT_EQ(charged_cpu_account(), &outer);
  }
  EXPECT_EQ(charged_cpu_account(), nullptr);
  burn(0.01);
  EXPECT_NEAR(outer.seconds(), 0.02, kSlack_s);
  EXPECT_NEAR(inner.seconds(), 0.03, kSlack_s);
}

// 2026-11-22: only the calling thread's time was told: with two threads half of a loop's cost went unseen.
TEST_F(CpuTime, EveryThreadOfALoopIsChargedToWhoStartedIt) {
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    CpuAccount account;
    {
      const ChargeCpu charge(&account);
      parallel_for(20, 1, [](std::size_t, std::size_t) { burn(0.01); });
    }
    EXPECT_GE(account.seconds(), 0.2) << count;
    EXPECT_LE(account.seconds(), 0.2 * 1.25) << count;  // a thread that waits at the loop's end looks out for work
  }
}

// As the runs of a comparison: each charges its own account, and the chunks of its inner loops go where it goes.
TEST_F(CpuTime, RunsSideBySideAreChargedApart) {
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    CpuAccount accounts[3];
    parallel_for(3, 1, [&](std::size_t run, std::size_t) {
      const ChargeCpu charge(&accounts[run]);
      parallel_for(5 * (run + 1), 1, [](std::size_t, std::size_t) { burn(0.005); });
    });
    for (std::size_t run = 0; run < 3; ++run) {
      const double spent_s = 0.025 * static_cast<double>(run + 1);
      EXPECT_GE(accounts[run].seconds(), spent_s) << count << " threads, run " << run;
      EXPECT_LE(accounts[run].seconds(), 1.25 * spent_s + kSlack_s) << count << " threads, run " << run;
    }
  }
}

}  // namespace
}  // namespace canyon
