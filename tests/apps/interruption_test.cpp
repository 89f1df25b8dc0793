// Ctrl-C and SIGTERM at several moments of several verbs: exit status 130 within a second, and no litter.
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/core/random/random.h"
#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

class Interruption : public testing::CommandLineTest {
 protected:
  struct Ended {
    int status = 0;  ///< of exit; -1: by a signal
    double after_s = 0.0;
    double cpu_s = 0.0;  ///< of the program itself from the signal on, seen at intervals: of the last look
  };
  /// Waits until the program has been loaded and listens to SIGINT: before, it ends as any program does.
  static void wait_until_it_listens(pid_t child) {
    for (int k = 0; k < 3000; ++k) {
      std::ifstream in("/proc/" + std::to_string(child) + "/status");
      for (std::string line; std::getline(in, line);) {
        if (line.rfind("State:\tZ", 0) == 0) return;  // it has ended already
        if (line.rfind("SigCgt:", 0) != 0) continue;
        if ((std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1U) != 0) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  /// Starts the verb, sends the signal after that time, as often as asked, and waits for the end.
  Ended interrupted(std::vector<std::string> words, double moment_s, int signal = SIGINT, int times = 1) const {
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.c_str()) != 0 || setenv("TMPDIR", folder_.c_str(), 1) != 0) _exit(99);
      std::freopen("stdout", "w", stdout);
      std::freopen("stderr", "w", stderr);
      std::string name = "canyon";
      std::vector<char*> arguments{name.data()};
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      execv(CANYON_BINARY, arguments.data());
      _exit(99);
    }
    wait_until_it_listens(child);
    wait_while_it_runs(child, moment_s);
    const auto asked = Clock::now();
    const double before_s = cpu_of(child).value_or(0.0);
    for (int k = 0; k < times; ++k) kill(child, signal);
    int status = 0;
    double cpu_s = 0.0;
    while (waitpid(child, &status, WNOHANG) == 0) {
      if (const auto now_s = cpu_of(child)) cpu_s = std::max(cpu_s, *now_s - before_s);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, std::chrono::duration<double>(Clock::now() - asked).count(),
            cpu_s};
  }
  /// Until the moment has come, or the child has ended before it; it is not reaped.
  static void wait_while_it_runs(pid_t child, double moment_s) {
    const auto begin = Clock::now();
    siginfo_t ended{};
    while (std::chrono::duration<double>(Clock::now() - begin).count() < moment_s && ended.si_pid == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT);
    }
  }
  /// User and system time that a process has taken, without its children; none of one that is no more.
  static std::optional<double> cpu_of(pid_t process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    if (!std::getline(in, text) || text.rfind(')') == std::string::npos) return std::nullopt;
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string word;
    for (int k = 0; k < 11; ++k) fields >> word;  // to the one before utime
    double user = 0.0, system = 0.0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }

  /// How many processes work in the folder or below it.
  static int processes_in(const std::string& folder) {
    int count = 0;
    std::error_code code;
    for (const auto& entry : fs::directory_iterator("/proc", code)) {
      const std::string at = fs::read_symlink(entry.path() / "cwd", code).string();
      count += !code && at.starts_with(folder) ? 1 : 0;
    }
    return count;
  }

  /// A verb that ended by itself before the signal came is complete; any other is interrupted.
  void expect_clean_end(const std::vector<std::string>& words, double moment_s, int signal = SIGINT) const {
    const Ended ended = interrupted(words, moment_s, signal);
    const std::string what = words[0] + " after " + std::to_string(moment_s) + " s: " + read("stderr");
    if (ended.status == 0) return;
    EXPECT_EQ(ended.status, 130) << what;
    // The promise is one second. A machine that does other things too shows it in CPU time, of as many threads as there
    // are processors; and ten seconds by the clock in any case.
    EXPECT_LT(ended.cpu_s, 1.0 * std::max(1U, std::thread::hardware_concurrency())) << what;
    EXPECT_LT(ended.after_s, 10.0) << what;
    EXPECT_EQ(read("stderr").rfind("interrupted: ", 0), 0U) << what;
    EXPECT_THAT(leftovers(), ::testing::IsEmpty()) << what;
  }
};

// 2026-11-22: phases that looked at no flag went on to their end: the making of the scene, the scoring of the maps.
TEST_F(Interruption, CompareAndRunAtAnyMoment) {
  for (const double moment_s : {0.02, 0.2, 0.7, 1.5, 4.0}) {
    expect_clean_end({"compare", "--out", "out"}, moment_s);
    expect_clean_end({"run", "--fidelity", "high", "--out", "deep/er/out"}, moment_s, SIGTERM);
  }
}

TEST_F(Interruption, ReportAtAnyMoment) {
  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --no-2x2 --out given_out"), 0) << read("stderr");
  const std::string page = read("given_out/report.html");
  for (const double moment_s : {0.0, 0.01, 0.03, 0.1, 0.3}) {
    expect_clean_end({"report", "given_out"}, moment_s);
    EXPECT_EQ(read("given_out/report.html"), page);
    for (const auto& entry : fs::directory_iterator(folder_ / "given_out"))
      EXPECT_EQ(entry.path().filename().string().find("partial"), std::string::npos) << entry.path();
  }
}

TEST_F(Interruption, LidarScanAtAnyMoment) {
  for (const double moment_s : {0.02, 0.4, 1.0, 2.0})
    expect_clean_end({"lidar", "scan", "--at", "213.9,30,0,90", "--scans", "1000000", "--beams", "hdl32e", "--out",
                      "scans", "--pcap", "scans.pcap"},
                     moment_s);
}

TEST_F(Interruption, PlanTradeoffAndStressAtAnyMoment) {
  for (const double moment_s : {0.05, 0.6, 2.5}) {
    expect_clean_end({"plan", "mission.toml", "--write", "given.plan", "--force", "--verify", "100000"}, moment_s);
    expect_clean_end({"tradeoff", "mission.toml", "--part", "fusion", "--out", "given_out", "--force"}, moment_s,
                     SIGTERM);
    expect_clean_end({"stress", "--long"}, moment_s);
    expect_clean_end({"reproduce", "--draws", "1000", "--out", "given_out", "--force"}, moment_s);
    expect_clean_end({"stress", "mission.toml"}, moment_s, SIGTERM);
  }
}

/// A verb at its work, and what it needs beforehand.
struct LongVerb {
  const char* name;
  std::vector<std::string> words;
  std::vector<std::string> before;  ///< calls of canyon
};

const LongVerb kLongVerbs[] = {
    {"compare", {"compare", "--out", "given_out", "--force"}, {}},
    {"compare_why", {"compare", "mission.toml", "--why", "--seeds", "100", "--out", "given_out", "--force"}, {}},
    {"compare_open_loop",
     {"compare", "mission.toml", "--open-loop", "--seeds", "100", "--out", "given_out", "--force"},
     {}},
    {"run", {"run", "mission.toml", "--out", "given_out", "--force"}, {}},
    {"plan", {"plan", "mission.toml", "--write", "given.plan", "--force", "--verify", "100000"}, {}},
    {"tradeoff", {"tradeoff", "mission.toml", "--out", "given_out", "--force"}, {}},
    {"stress_cases", {"stress", "--long"}, {}},
    {"stress_mission", {"stress", "mission.toml"}, {}},
    {"reproduce", {"reproduce", "--draws", "1000", "--out", "given_out", "--force"}, {}},
    {"report", {"report", "given_out"}, {"compare mission.toml --fidelities low,high --no-2x2 --out given_out"}},
    {"scene_make", {"scene", "make", "city", "--out", "given_city", "--force"}, {}},
    {"scene_info", {"scene", "info", "given_city/scene.json"}, {"scene make city --out given_city"}},
    {"gnss_simulate",
     {"gnss", "simulate", "--at", "32.3,-90.9,50", "--duration", "100000", "--rinex-obs", "given.rnx", "--force"},
     {}},
    {"gnss_solve",
     {"gnss", "solve", "--obs", "given.rnx", "--nav", "given.nav", "--out", "given.csv", "--force"},
     {"gnss simulate --at 32.3,-90.9,50 --duration 6000 --rinex-obs given.rnx --rinex-nav given.nav"}},
    {"gnss_drive_check",
     {"gnss", "drive-check", "--obs", "given.rnx", "--nav", "given.nav", "--truth", "given_way.csv", "--scene",
      "vicksburg", "--draws", "100", "--out", "given_check", "--force"},
     {"gnss simulate --trajectory given_way.csv --rate 1 --rinex-obs given.rnx --rinex-nav given.nav"}},
    {"gnss_map", {"gnss", "map", "--out", "given_map", "--force"}, {}},
    {"gnss_sky",
     {"gnss", "sky", "--scene", "vicksburg", "--xy", "120,-40", "--duration", "86400", "--step", "1", "--out",
      "given_sky", "--force"},
     {}},
    {"imu_simulate",
     {"imu", "simulate", "--path", "circle", "--duration", "40000", "--out", "given_log", "--force"},
     {}},
    {"imu_allan",
     {"imu", "allan", "given_log/imu.csv"},
     {"imu simulate --at 45,7,200 --duration 7200 --out given_log"}},
    {"imu_fit",
     {"imu", "fit", "given_log/imu.csv", "--static"},
     {"imu simulate --at 45,7,200 --duration 7200 --out given_log"}},
    {"imu_dead_reckon",
     {"imu", "dead-reckon", "--imu", "given_log/imu.csv", "--truth", "given_log/truth.nav", "--out", "given_drift",
      "--force"},
     {"imu simulate --at 45,7,200 --duration 7200 --out given_log"}},
    {"fuse",
     {"fuse", "--results", "given_out", "--run", "high", "--smoother", "batch_graph", "--out", "given_fused",
      "--force"},
     {"run --fidelity high --set run.record_filter_input=true --set 'registration.method=\"none\"' --out given_out"}},
    {"lidar_scan",
     {"lidar", "scan", "--at", "213.9,30,0,90", "--scans", "1000000", "--beams", "hdl32e", "--out", "given_scans",
      "--force"},
     {}},
    {"tolerance", {"tolerance", "mission.toml", "--seeds", "1000", "--out", "given_out", "--force"}, {}},
    {"lidar_evaluate",
     {"lidar", "evaluate", "given_out/clouds/high_prior.pcd"},
     {"run --fidelity high --set time.limit_s=60 --set 'registration.method=\"none\"' --out given_out"}},
    {"lidar_register",
     {"lidar", "register", "given_out/clouds/high_prior.pcd", "given_out/clouds/high_prior.pcd", "--leaf", "0.01"},
     {"run --fidelity high --set time.limit_s=60 --set 'registration.method=\"none\"' --out given_out"}},
    {"lidar_error_budget",
     {"lidar", "error-budget", "mission.toml", "--fidelity", "high", "--seeds", "100", "--out", "given_budget",
      "--force"},
     {}},
    {"lidar_error_events",
     {"lidar", "error-events", "mission.toml", "--fidelity", "high", "--seeds", "100", "--out", "given_events",
      "--force"},
     {}},
    {"lidar_close_loops", {"lidar", "close-loops", "--fidelity", "low", "--out", "given_closed", "--force"}, {}},
    {"lidar_error_response",
     {"lidar", "error-response", "--fidelity", "low", "--seeds", "100", "--out", "given_response", "--force"},
     {}},
};

class InterruptionNightly : public Interruption, public ::testing::WithParamInterface<LongVerb> {};

// Twenty moments that nobody has chosen, within what the verb takes, or its first eight seconds.
TEST_P(InterruptionNightly, AtRandomMoments) {
  const LongVerb& verb = GetParam();
  std::string way;
  for (int k = 0; k <= 60; ++k)
    way += "1610," + std::to_string(306000 + k) + "," + std::to_string(32.35 + 2e-5 * k) + ",-90.88,60\n";
  write("given_way.csv", way);
  for (const std::string& words : verb.before) ASSERT_EQ(canyon(words), 0) << words << ": " << read("stderr");
  const auto started = Clock::now();
  const Ended whole = interrupted(verb.words, 8.0);
  ASSERT_TRUE(whole.status == 0 || whole.status == 130) << whole.status << ": " << read("stderr");
  const double longest_s = std::min(8.0, std::chrono::duration<double>(Clock::now() - started).count());
  const RandomStream stream(15, std::string("test.interruption.") + verb.name);
  int interrupted_ones = 0;
  for (std::uint64_t k = 0; k < 20; ++k) {
    expect_clean_end(verb.words, stream.uniform(0.0, longest_s, 0, k), k % 2 == 0 ? SIGINT : SIGTERM);
    interrupted_ones += read("stderr").rfind("interrupted: ", 0) == 0 ? 1 : 0;
  }
  EXPECT_GE(interrupted_ones, 10) << "most end before they are asked to";
}
INSTANTIATE_TEST_SUITE_P(EveryLongVerb, InterruptionNightly, ::testing::ValuesIn(kLongVerbs),
                         [](const auto& verb) { return std::string(verb.param.name); });

// 2026-11-22: the reading of a pipe that nobody writes to could not be interrupted.
TEST_F(Interruption, WhatWaitsForAPipeEnds) {
  ASSERT_EQ(mkfifo(path("given_pipe.toml").c_str(), 0600), 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    const Ended ended = interrupted({"run", "given_pipe.toml", "--out", "out"}, 0.5, signal);
    EXPECT_EQ(ended.status, 130);
    EXPECT_LT(ended.after_s, 10.0);
    EXPECT_THAT(leftovers(), ::testing::IsEmpty());
  }
  const Ended at_once = interrupted({"run", "given_pipe.toml", "--out", "out"}, 0.5, SIGINT, 2);
  EXPECT_EQ(at_once.status, 130);
}

// 2026-11-22: `timeout` sends its signal to the process and to its group: twice, and that must leave no litter either.
TEST_F(Interruption, TwoRequestsLeaveNoLitterEither) {
  for (const double moment_s : {0.3, 1.0}) {
    const Ended ended = interrupted({"compare", "--out", "out"}, moment_s, SIGTERM, 2);
    EXPECT_EQ(ended.status, 130);
    EXPECT_THAT(leftovers(), ::testing::IsEmpty());
  }
  // 2026-11-22: /tmp/canyon-stress-* stayed, and its trials went on.
  for (const double moment_s : {0.3, 1.0, 2.0}) {
    const Ended ended = interrupted({"stress", "mission.toml"}, moment_s, SIGTERM, 2);
    EXPECT_EQ(ended.status, 130);
    EXPECT_THAT(leftovers(), ::testing::IsEmpty());
    EXPECT_EQ(processes_in(folder_.string()), 0);
  }
}

// 2026-11-26: a sweep of an hour and a half that was ended said nothing of what it had found.
TEST_F(Interruption, ASweepTellsWhatItHasFound) {
  // Later where the machine does other things too: the first trial has to have ended.
  for (const double moment_s : {10.0, 30.0, 90.0}) {
    const Ended ended = interrupted({"stress", "mission.toml", "--json"}, moment_s, SIGTERM);
    EXPECT_EQ(ended.status, 130);
    EXPECT_THAT(leftovers(), ::testing::IsEmpty());
    if (!read("stdout").empty()) break;
  }
  ASSERT_FALSE(read("stdout").empty());
  const auto found = nlohmann::json::parse(read("stdout"));
  EXPECT_TRUE(found["interrupted"]);
  EXPECT_GT(found["values_tried"].get<int>(), 0);
  EXPECT_GT(found["not_tried"].get<int>(), 500);
}

TEST_F(Interruption, WhatAKilledRunLeftGoesWithTheNext) {
  const Ended killed = interrupted({"compare", "--out", "out"}, 2.5, SIGKILL);
  EXPECT_EQ(killed.status, -1);
  ASSERT_EQ(canyon("run mission.toml --fidelity low --out given_other"), 0) << read("stderr");
  EXPECT_THAT(leftovers(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace canyon::apps
