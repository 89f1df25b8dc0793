#include "canyon/core/process/ordered_work.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/parallel.h"

namespace canyon {
namespace {

using namespace std::chrono_literals;

class OrderedWorkTest : public ::testing::Test {
 protected:
  ~OrderedWorkTest() override { set_threads(0); }
};

TEST_F(OrderedWorkTest, AllIsDoneInOrderAndOneAtATime) {
  for (const int count : {1, 2, 8}) {
    set_threads(count);
    std::vector<int> order;  // unguarded: one at a time
    std::atomic<int> running = 0, most = 0;
    OrderedWork work(2);
    for (int i = 0; i < 500; ++i) {
      work.add([&, i] {
        most = std::max(most.load(), ++running);
        std::atomic<int> loop = 0;
        parallel_for(20, 1, [&](std::size_t, std::size_t) { ++loop; });
        order.push_back(i + loop - 20);
        --running;
      });
    }
    work.wait();
    ASSERT_EQ(order.size(), 500U) << count;
    for (int i = 0; i < 500; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i) << count;
    EXPECT_EQ(most, 1) << count;
  }
}

TEST_F(OrderedWorkTest, TheGiverGoesOnWhileAnotherThreadWorks) {
  set_threads(2);
  std::atomic<bool> began = false, let_go = false;
  std::optional<std::thread::id> by;
  OrderedWork work(2);
  work.add([&] {
    by = std::this_thread::get_id();
    began = true;
    while (!let_go) std::this_thread::sleep_for(1ms);
  });
  while (!began) std::this_thread::sleep_for(1ms);  // an idle thread takes it up
  let_go = true;
  work.wait();
  EXPECT_NE(by, std::this_thread::get_id());
}

// As where each thread drives a run of its own: nobody is idle, and nobody waits for ever.
TEST_F(OrderedWorkTest, WhereNobodyIsIdleTheGiverDoesItself) {
  set_threads(2);
  std::atomic<int> done = 0;
  parallel_for(6, 1, [&](std::size_t, std::size_t) {
    std::thread waited_for([&] {
      const OwnRoom room;
      OrderedWork work(2);
      for (int i = 0; i < 50; ++i) work.add([&] { parallel_for(8, 1, [&](std::size_t, std::size_t) { ++done; }); });
      work.wait();
    });
    waited_for.join();
  });
  EXPECT_EQ(done, 6 * 50 * 8);
}

TEST_F(OrderedWorkTest, WithOneThreadItIsDoneAtOnce) {
  set_threads(1);
  OrderedWork work(2);
  std::optional<std::thread::id> by;
  work.add([&] { by = std::this_thread::get_id(); });
  EXPECT_EQ(by, std::this_thread::get_id());
}

TEST_F(OrderedWorkTest, WhatAPieceThrowsReachesTheGiverAndEndsTheLine) {
  for (const int count : {1, 2}) {
    set_threads(count);
    OrderedWork work(2);
    std::atomic<int> after = 0;
    const auto give = [&] {
      work.add([] { throw std::runtime_error("piece"); });
      for (int i = 0; i < 3; ++i) work.add([&] { ++after; });
      work.wait();
    };
    EXPECT_THROW(give(), std::runtime_error) << count;
    EXPECT_EQ(after, 0) << count;
    work.add([&] { ++after; });  // a line goes on
    work.wait();
    EXPECT_EQ(after, 1) << count;
  }
}

TEST_F(OrderedWorkTest, ItsEndWaitsForThePieceThatIsBeingDoneAlone) {
  set_threads(2);
  std::atomic<int> done = 0;
  std::atomic<bool> began = false;
  {
    OrderedWork work(2);
    work.add([&] {
      began = true;
      std::this_thread::sleep_for(20ms);
      ++done;
    });
    while (!began) std::this_thread::sleep_for(1ms);
    work.add([&] { done += 100; });
  }
  EXPECT_EQ(done, 1);
}

TEST_F(OrderedWorkTest, CpuTimeGoesToWhoGaveIt) {
  const auto cpu_s = [] {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  for (const int count : {1, 2}) {
    set_threads(count);
    CpuAccount account;
    OrderedWork work(2);
    {
      const ChargeCpu charge(&account);
      work.add([&] {
        const double until_s = cpu_s() + 0.03;
        while (cpu_s() < until_s) {
        }
      });
    }
    work.wait();
    EXPECT_GE(account.seconds(), 0.03) << count;
    EXPECT_LT(account.seconds(), 0.2) << count;
  }
}

}  // namespace
}  // namespace canyon
