// Ctrl-C and SIGTERM during the verbs on inertial data: done at once, exit status 130, nothing left behind.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/tests/apps/command_line_fixture.h"
#include "canyon/tests/apps/signalled_verb.h"

namespace canyon::apps {
namespace {

class ImuSignalsTest : public testing::CommandLineTest {
 protected:
  /// Tells the verb to stop at several stages of its work: while it reads, computes and writes.
  void expect_stops(const std::vector<std::string>& words, const std::vector<double>& after_cpu_s) const {
    int interrupted = 0;
    for (const double cpu_s : after_cpu_s)
      for (const int signal : {SIGINT, SIGTERM}) {
        const auto end = testing::signal_verb(folder_.string(), words, cpu_s, signal);
        if (end.ended_before) {
          EXPECT_EQ(end.status, 0) << read("stderr");
          std::filesystem::remove_all(path("out"));
          continue;
        }
        ++interrupted;
        EXPECT_EQ(end.status, 130) << words[1] << " after " << cpu_s << " s: " << read("stderr");
        EXPECT_LT(end.cpu_after_signal_s, 1.0) << words[1] << " after " << cpu_s << " s";
        EXPECT_THAT(leftovers(), ::testing::IsEmpty()) << words[1] << " after " << cpu_s << " s";
      }
    EXPECT_GE(interrupted, 2) << words[1] << ": the log is too short for this machine";
  }
};

// 2026-11-22: imu simulate looked at the flag once in 256 samples, which of a fast path took minutes, and never while
// it drew errors or wrote.
TEST_F(ImuSignalsTest, Simulate) {
  expect_stops({"imu", "simulate", "--path", "figure_eight", "--duration", "3000", "--rate", "200", "--threads", "1",
                "--out", "out"},
               {0.1, 1.0, 2.5, 4.0});
  expect_stops({"imu", "simulate", "--path", "circle", "--set", "radius_m=0.001", "--set", "speed_m_s=100", "--threads",
                "1", "--out", "out"},
               {0.5});
}

// 2026-11-22: none of these verbs looked at the flag at all.
TEST_F(ImuSignalsTest, AllanFitAndDeadReckon) {
  ASSERT_EQ(canyon("imu simulate --at 45,7,200 --errors full --duration 3000 --rate 200 --out given_still"), 0)
      << read("stderr");
  const std::string log = "given_still/imu.csv", truth = "given_still/truth.nav";
  expect_stops({"imu", "allan", log, "--kind", "modified,hadamard,total", "--threads", "1", "--out", "out"},
               {0.1, 1.0});
  expect_stops({"imu", "fit", log, "--static", "--threads", "1", "--out", "out"}, {0.1, 1.0});
  expect_stops({"imu", "dead-reckon", "--imu", log, "--truth", truth, "--threads", "1", "--out", "out"},
               {0.1, 0.7, 2.0});
}

}  // namespace
}  // namespace canyon::apps
