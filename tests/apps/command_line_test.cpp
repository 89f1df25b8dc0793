// The binary as a user calls it: exit status, messages, files.
#include <sys/wait.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/command_line_fixture.h"
#include "tests/support/test_data.h"

namespace canyon::apps {
namespace {

namespace fs = std::filesystem;
using testing::CommandLineTest;
using ::testing::HasSubstr;
using testing::kMission;

TEST_F(CommandLineTest, CompareWritesACompleteDirectoryAndOneJsonObject) {
  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --out out --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));  // exactly one object: anything else does not parse
  EXPECT_EQ(json["runs"].size(), 4U);
  EXPECT_EQ(json["seed"], 1);
  EXPECT_EQ(json["results_dir"], "out");
  EXPECT_EQ(json["hash"].get<std::string>().size(), 64U);
  EXPECT_TRUE(json["runs"][0].contains("cpu_s"));
  EXPECT_TRUE(json["runs"][0].contains("real_time_factor"));
  for (const char* file :
       {"summary.json", "manifest.json", "scene.json", "report.html", "epochs/low_nav.csv", "epochs/high_gnss.csv",
        "epochs/high_satellites.csv", "epochs/low_keyframes.csv", "clouds/low_prior.pcd", "clouds/high_registered.pcd"})
    EXPECT_GT(fs::file_size(folder_ / "out" / file), 0U) << file;
  EXPECT_EQ(read("stderr"), "");  // silent when piped

  // The same call gives the same hash; the report can be made again.
  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --out again --json --threads 1"), 0);
  EXPECT_EQ(nlohmann::json::parse(read("stdout"))["hash"], json["hash"]);
  fs::remove(folder_ / "out" / "report.html");
  EXPECT_EQ(canyon("report out"), 0);
  EXPECT_GT(fs::file_size(folder_ / "out" / "report.html"), 0U);
}

TEST_F(CommandLineTest, ExistingOutputIsRefusedWithoutForce) {
  fs::create_directories(folder_ / "given_out");
  expect_mistake("run mission.toml --out given_out", "given_out: ");
  EXPECT_TRUE(fs::is_empty(folder_ / "given_out"));
  EXPECT_EQ(canyon("run mission.toml --fidelity low --out given_out --force"), 0) << read("stderr");
  EXPECT_TRUE(fs::exists(folder_ / "given_out" / "summary.json"));
}

TEST_F(CommandLineTest, ForceNeverReplacesAForeignDirectory) {
  fs::create_directories(folder_ / "given_home");
  write("given_home/thesis.txt", "years");
  expect_mistake("run mission.toml --fidelity low --out given_home --force",
                 "given_home: not a results directory, expected one that canyon wrote, an empty one or a new name\n");
  EXPECT_EQ(canyon("gnss sky --at 32,-90,10 --out given_home --force"), 2);
  EXPECT_EQ(read("given_home/thesis.txt"), "years");
}

TEST_F(CommandLineTest, Mistakes) {
  expect_mistake("run nothing.toml --out out", "nothing.toml");
  write("key.toml", std::string(kMission) + "[gnss]\nrate_hzz = 2.0\n");
  expect_mistake("run key.toml --out out", "key.toml:15: gnss.rate_hzz: ");
  write("range.toml", std::string(kMission) + "[lidar]\nrate_hz = -1.0\n");
  expect_mistake("run range.toml --out out", "range.toml:15: lidar.rate_hz: ");
  write("torn.toml", "[gnss\n");
  expect_mistake("run torn.toml --out out", "torn.toml:1: ");
  expect_mistake("run mission.toml --fidelity highest --out out",
                 "mission.toml: fidelity.highest: unknown fidelity, expected one of ");
  expect_mistake("run mission.toml --start yesterday --out out", "--start: time.start: ");
  expect_mistake("run mission.toml --nav nothing.10n --out out", "nothing.10n");
  expect_mistake("run mission.toml --frobnicate", "--frobnicate");
  expect_mistake("report nowhere", "nowhere");
}

TEST_F(CommandLineTest, DamagedNavigationFiles) {
  write("given.10n", "this is not RINEX\n");
  expect_mistake("run mission.toml --nav given.10n --out out", "given.10n:1: ");
  write("given_empty.10n", "");
  expect_mistake("run mission.toml --nav given_empty.10n --out out", "given_empty.10n");
}

TEST_F(CommandLineTest, OutputThatCannotBeWritten) {
  write("given_file", "a file, not a directory");
  expect_mistake("run mission.toml --out given_file/out", "given_file/out: ");
}

TEST_F(CommandLineTest, InterruptedRunsStopWithinASecondAndLeaveNothing) {
  write("long.toml", std::string(kMission) + "[run]\nname = \"long\"\n");
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder_.c_str()) != 0) _exit(99);
    std::freopen("stdout", "w", stdout);
    std::freopen("stderr", "w", stderr);
    execl(CANYON_BINARY, "canyon", "compare", "--out", "out",
          static_cast<char*>(nullptr));  // the whole mission: minutes
    _exit(99);
  }
  std::this_thread::sleep_for(std::chrono::seconds(4));
  const auto asked = std::chrono::steady_clock::now();
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  const double waited_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  // A limit on behaviour, not a benchmark: the promise is one second; a loaded machine gets ten.
  EXPECT_LT(waited_s, 10.0);
  EXPECT_THAT(leftovers(), ::testing::IsEmpty());
}

TEST_F(CommandLineTest, HelpShowsAnExampleForEveryVerb) {
  for (const char* verb : {"compare", "run", "report"}) {
    EXPECT_EQ(canyon(std::string(verb) + " --help"), 0);
    EXPECT_THAT(read("stdout"), HasSubstr(std::string("canyon ") + verb));
    EXPECT_THAT(read("stdout"), HasSubstr("Example:"));
  }
}

TEST_F(CommandLineTest, RealNavigationFileOfTheDay) {
  CANYON_REAL_DATA(nav, "gnss/orbit_2010_182/brdc1820.10n");
  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --no-2x2 --nav " + nav +
                   " --start 2010-07-01T13:00:00 --out out --json"),
            0)
      << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_TRUE(json["runs"][1]["gdop_median"].is_number());
  // A day that the file does not cover: one line that says what it covers.
  EXPECT_EQ(canyon("run mission.toml --nav " + nav + " --start 2012-01-01T00:00:00 --out out2"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("brdc1820.10n"));
  EXPECT_FALSE(fs::exists(folder_ / "out2"));
}

}  // namespace
}  // namespace canyon::apps
