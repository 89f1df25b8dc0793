// 2026-11-22: Ctrl-C and SIGTERM end every gnss verb, whatever it is at, within a second, with status 130 and no
// litter.
#include <csignal>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

#include <sys/resource.h>
#include <sys/wait.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/time.h"
#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using ::testing::IsEmpty;

class GnssInterruptTest : public testing::CommandLineTest {
 protected:
  /// Processor time of a live process, s.
  static double cpu_s(pid_t pid) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string text((std::istreambuf_iterator<char>(stat)), {});
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double user = 0.0, system = 0.0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }

  /// Calls canyon, signals it after each of the delays, and looks at what it does then. What is asked is processor
  /// time, on one thread: a loaded machine makes no difference. At least one of the calls must have been interrupted.
  void expect_ends_soon(const std::string& arguments, const std::vector<double>& delays_s = {0.3, 1.2, 2.5}) {
    int interrupted = 0, signal = SIGTERM;
    for (const double delay_s : delays_s) {
      signal = signal == SIGINT ? SIGTERM : SIGINT;
      const pid_t child = fork();
      ASSERT_GE(child, 0);
      if (child == 0) {
        if (chdir(folder_.c_str()) != 0) _exit(99);
        if (std::freopen("stdout", "w", stdout) == nullptr || std::freopen("stderr", "w", stderr) == nullptr) _exit(99);
        const std::string command = "exec '" CANYON_BINARY "' " + arguments + " --threads 1";
        execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
        _exit(99);
      }
      while (!ended(child) && cpu_s(child) < delay_s) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      const double before_s = cpu_s(child);
      kill(child, signal);
      int status = 0;
      rusage used{};
      wait4(child, &status, 0, &used);
      const double all_s = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
      ASSERT_TRUE(WIFEXITED(status)) << arguments << " at " << delay_s << " s: signal " << WTERMSIG(status);
      if (WEXITSTATUS(status) == 0) {
        for (const std::string& name : leftovers()) std::filesystem::remove_all(folder_ / name);
        continue;  // it had been quicker
      }
      ++interrupted;
      EXPECT_EQ(WEXITSTATUS(status), 130) << arguments << " at " << delay_s << " s: " << read("stderr");
      EXPECT_LT(all_s - before_s, 1.0) << arguments << " at " << delay_s << " s";
      EXPECT_THAT(leftovers(), IsEmpty()) << arguments << " at " << delay_s << " s";
    }
    EXPECT_GT(interrupted, 0) << arguments;
  }

  static bool ended(pid_t child) {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child;
  }

  /// A navigation file of the built-in satellites for the day of kStart.
  void write_navigation() {
    ASSERT_EQ(canyon("gnss simulate --at 32.35,-90.88,60 --duration 60 --rinex-nav given.nav"), 0) << read("stderr");
  }
};

const GpsTime kStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

TEST_F(GnssInterruptTest, SimulateAndItsFiles) {
  expect_ends_soon("gnss simulate --at 32.35,-90.88,60 --duration 2592000 --out out --nmea log.nmea --rinex-obs o.rnx");
  // 2600 epochs in some 3 s, then navigation records of a month are fitted for over a minute.
  expect_ends_soon("gnss simulate --at 32.35,-90.88,60 --duration 2592000 --rate 1e-3 --systems GREC --rinex-nav n.rnx",
                   {1.2, 7.0});
}

TEST_F(GnssInterruptTest, SkyAndMap) {
  expect_ends_soon("gnss sky --at 32.35,-90.88,60 --duration 604800 --step 0.1 --out sky");
  expect_ends_soon("gnss map --scene vicksburg --cell 50 --duration 604800 --step 1 --out map", {2.5, 4.0});
}

TEST_F(GnssInterruptTest, SolveOfALongFileReadingAndSolving) {
  write_navigation();
  {
    std::ofstream out(path("given.rnx"));
    out << "     3.04           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"
           "G    1 C1C                                                  SYS / # / OBS TYPES\n"
           "                                                            END OF HEADER\n";
    char line[64];
    for (int k = 0; k < 150000; ++k) {
      const CalendarTime c = calendar(kStart + 0.005 * k);
      std::snprintf(line, sizeof line, "> %4d %02d %02d %02d %02d %10.7f  0  8\n", c.year, c.month, c.day, c.hour,
                    c.minute, c.second);
      out << line;
      for (const int prn : {1, 3, 7, 10, 11, 14, 20, 23}) {
        std::snprintf(line, sizeof line, "G%02d  2%d123456.789\n", prn, prn % 5);
        out << line;
      }
    }
  }
  expect_ends_soon("gnss solve --obs given.rnx --nav given.nav --systems G --out positions", {0.3, 1.2, 4.0});
}

class OrbitErrorInterruptTest : public GnssInterruptTest {
 protected:
  void SetUp() override {
    GnssInterruptTest::SetUp();
    write_navigation();
    std::ofstream out(path("given.sp3"));
    out << "#cP2010 11 17 13  0  0.00000000  150000 ORBIT IGS08 FIT TEST\n"
           "## 1610 306000.00000000     0.04000000 55517 0.5416666666667\n"
           "%c G  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";
    char line[96];
    for (int k = 0; k < 150000; ++k) {
      const CalendarTime c = calendar(kStart + 0.04 * k);
      std::snprintf(line, sizeof line, "*  %4d %2d %2d %2d %2d %11.8f\n", c.year, c.month, c.day, c.hour, c.minute,
                    c.second);
      out << line;
      for (const int prn : {1, 3, 7, 10, 11, 14}) {
        std::snprintf(line, sizeof line, "PG%02d  15000.%06d  -2000.%06d  21000.123456    123.456789\n", prn, k, k);
        out << line;
      }
    }
    out << "EOF\n";
  }
  const std::string verb_ = "gnss orbit-error --nav given.nav --sp3 given.sp3 --out errors";
};

TEST_F(OrbitErrorInterruptTest, OfALongFile) {
  expect_ends_soon(verb_, {0.2, 0.8, 1.6, 2.4});
}

// Twenty moments that nobody has chosen, as of the other verbs (interruption_test.cpp).
TEST_F(OrbitErrorInterruptTest, OfALongFileAtRandomMomentsNightly) {
  const RandomStream stream(15, "test.interruption.gnss_orbit_error");
  std::vector<double> moments_s;
  for (std::uint64_t k = 0; k < 20; ++k) moments_s.push_back(stream.uniform(0.0, 2.4, 0, k));
  expect_ends_soon(verb_, moments_s);
}

}  // namespace
}  // namespace canyon::apps
