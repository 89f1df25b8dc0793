// The binary as a user calls it: exit status, messages, files.
#include <sys/wait.h>

#include <algorithm>
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

#include "canyon/core/files/files.h"
#include "canyon/tests/apps/command_line_fixture.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::apps {
namespace {

namespace fs = std::filesystem;
using testing::CommandLineTest;
using ::testing::HasSubstr;
using testing::kMission;

TEST_F(CommandLineTest, CompareWritesACompleteDirectoryAndOneJsonObject) {
  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --out out --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));  // exactly one object: anything else does not parse
  EXPECT_EQ(json["runs"].size(), 2U) << "one closed loop of each says nothing of which sensor it was";
  EXPECT_TRUE(json["two_by_two"].is_null());
  EXPECT_EQ(json["seed"], 1);
  EXPECT_EQ(json["results_dir"], "out");
  EXPECT_EQ(json["hash"].get<std::string>().size(), 64U);
  EXPECT_TRUE(json["runs"][0].contains("cpu_s"));
  EXPECT_TRUE(json["runs"][0].contains("real_time_factor"));
  for (const char* file : {"summary.json", "manifest.json", "scene.json", "report.html", "epochs/low_nav.csv",
                           "epochs/high_gnss.csv", "epochs/high_satellites.csv", "epochs/low_keyframes.csv",
                           "clouds/low_prior.pcd", "clouds/high_prior.pcd", ".canyon"})
    EXPECT_GT(fs::file_size(folder_ / "out" / file), 0U) << file;
  EXPECT_EQ(read("stderr"), "");  // silent when piped

  // The hash, computed again as docs/results.md says.
  std::vector<std::string> files;
  for (const char* folder : {"clouds", "epochs"})
    for (const auto& entry : fs::directory_iterator(folder_ / "out" / folder))
      files.push_back(std::string(folder) + "/" + entry.path().filename().string());
  std::sort(files.begin(), files.end());
  std::string digest;
  for (const std::string& file : files) digest += file + " " + sha256_hex(read("out/" + file)) + "\n";
  auto plain = nlohmann::ordered_json::parse(read("out/summary.json"));
  plain.erase("hash");
  plain.erase("timing");
  for (auto& run : plain["runs"]) run.erase("timing");
  EXPECT_EQ(sha256_hex(digest + plain.dump()), json["hash"]);

  // The object is summary.json, and more.
  const auto summary = nlohmann::json::parse(read("out/summary.json"));
  for (const auto& [key, value] : summary.items()) {
    if (key != "runs") {
      EXPECT_EQ(json[key], value) << key;
    }
  }
  // Nothing is registered: nothing is said of registered maps, and the limit is the one that holds.
  EXPECT_FALSE(fs::exists(folder_ / "out/clouds/high_registered.pcd"));
  EXPECT_TRUE(json["runs"][1]["map_error_rms_m"].is_null());
  EXPECT_TRUE(json["runs"][1]["keyframes_converged"].is_null());
  EXPECT_TRUE(json["runs"][1]["map_error_prior_rms_m"].is_number());
  EXPECT_EQ(json["runs"][1]["counters"]["keyframes_registered"], 0);
  EXPECT_THAT(read("out/epochs/high_keyframes.csv"), HasSubstr(",not_registered,0,"));
  EXPECT_EQ(json["mission"]["time_limit_s"], 4.0);

  // The same call gives the same hash; the report can be made again.
  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --out again --json --threads 1"), 0);
  EXPECT_EQ(nlohmann::json::parse(read("stdout"))["hash"], json["hash"]);
  fs::remove(folder_ / "out" / "report.html");
  EXPECT_EQ(canyon("report out"), 0);
  EXPECT_GT(fs::file_size(folder_ / "out" / "report.html"), 0U);
}

TEST_F(CommandLineTest, SeveralSeedsGiveSharesAndDifferences) {
  const std::string call = "compare mission.toml --fidelities low,high --no-2x2 --seed 5 --seeds 3 ";
  ASSERT_EQ(canyon(call + "--out out --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  ASSERT_EQ(json["runs"].size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(json["runs"][i]["seed"], 5 + i / 2);
    EXPECT_EQ(json["runs"][i]["fidelity"], i % 2 == 0 ? "low" : "high");
    EXPECT_TRUE(json["runs"][i].contains("cpu_s"));
  }
  EXPECT_EQ(json["seed"], 5);
  EXPECT_EQ(json["seeds"], (std::vector<int>{5, 6, 7}));
  ASSERT_EQ(json["shares"].size(), 2U);
  EXPECT_EQ(json["shares"][0]["n"], 0);
  EXPECT_EQ(json["shares"][0]["outcomes"]["stopped"], 3);  // the limit of 4 s
  ASSERT_EQ(json["paired"].size(), 1U);
  EXPECT_EQ(json["paired"][0]["b"], "high");
  EXPECT_TRUE(json["shares"][0]["low"].is_null());
  EXPECT_EQ(json["paired"][0]["n"], 0);
  EXPECT_TRUE(json["paired"][0]["difference"].is_null());
  EXPECT_TRUE(json["paired"][0]["p"].is_null());
  // Rows are kept of the first seed.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out/clouds"), {}), 2);
  EXPECT_THAT(read("out/report.html"), HasSubstr("Over 3 seeds"));

  // Another number of threads: the same bits. The table for people.
  ASSERT_EQ(canyon(call + "--out again --threads 1 --figures position_error_rms_m"), 0) << read("stderr");
  EXPECT_EQ(nlohmann::json::parse(read("again/summary.json"))["hash"], json["hash"]);
  const std::string table = read("stdout");
  EXPECT_THAT(table, HasSubstr("median over 3 seeds, 5 to 7"));
  EXPECT_THAT(table, HasSubstr("  position error, RMS, m"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("GDOP")));
  EXPECT_THAT(table, ::testing::AllOf(HasSubstr("all stopped"), HasSubstr("stopped 3")));
}

TEST_F(CommandLineTest, MixedRunsAreMadeOnOneTrueMotionAndOverSeeds) {
  ASSERT_EQ(canyon("compare mission.toml --open-loop --fidelities low,high --out out --json"), 0) << read("stderr");
  EXPECT_EQ(nlohmann::json::parse(read("stdout"))["runs"].size(), 4U);
  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --seeds 2 --out given_seeds --json"), 0)
      << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_EQ(json["runs"].size(), 8U);
  EXPECT_EQ(json["two_by_two"]["successes"], (nlohmann::json{{0, 0}, {0, 0}}));
  EXPECT_EQ(json["two_by_two"]["ended"], (nlohmann::json{{0, 0}, {0, 0}})) << "all are stopped";
}

TEST_F(CommandLineTest, SeedsInAnOpenLoopMeetOneTrueMotion) {
  ASSERT_EQ(canyon("compare mission.toml --open-loop --fidelities low,high --no-2x2 --seeds 2 --out out --json"), 0)
      << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_TRUE(json["shares"].is_null());
  EXPECT_EQ(json["runs"][0]["distance_m"], json["runs"][2]["distance_m"]);
  EXPECT_NE(json["runs"][0]["position_error_rms_m"], json["runs"][2]["position_error_rms_m"]);
  double difference = 0.0;
  for (const std::size_t seed : {0U, 1U})
    difference += json["runs"][2 * seed + 1]["position_error_rms_m"].get<double>() -
                  json["runs"][2 * seed]["position_error_rms_m"].get<double>();
  bool found = false;
  for (const auto& pair : json["paired"])
    if (pair["figure"] == "position_error_rms_m") {
      found = true;
      EXPECT_NEAR(pair["difference"].get<double>(), difference / 2, 1e-12);
    }
  EXPECT_TRUE(found);
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
                 "--fidelity: \"highest\" is unknown, expected one of high, high_aided, low, modern, paper; nearest is "
                 "\"high\"\n");
  expect_mistake("run mission.toml --start yesterday --out out", "--start: time.start: ");
  expect_mistake("run mission.toml --nav nothing.10n --out out", "nothing.10n");
  expect_mistake(
      "run mission.toml --nav nothing.10n --out out",
      "--nav: gnss.nav_file: \"nothing.10n\" cannot be read (No such file or directory), expected a readable "
      "file\n");
  expect_mistake("compare mission.toml --fidelities low,low --out out",
                 "--fidelities: \"low\" given twice, expected each fidelity once\n");
  expect_mistake("compare mission.toml --figures distance_m,map_eror_rms_m --out out",
                 "--figures: \"map_eror_rms_m\" is no figure, expected one that canyon keys "
                 "--figures lists; nearest is \"map_error_rms_m\"\n");
  for (const char* seeds : {"0", "1", "-3", "2.5", "many"})
    expect_mistake("compare mission.toml --out out --seeds " + std::string(seeds), "--seeds: ");
  expect_mistake("compare mission.toml --out out --seed 9000000000000000 --seeds 2",
                 "--seeds: 2 seeds from 9000000000000000 on, expected none beyond 9000000000000000\n");
  expect_mistake("compare mission.toml --out out --seeds 2 --open-loop --tape nowhere.tape", "nowhere.tape");
  expect_mistake("report nowhere", "nowhere");
}

TEST_F(CommandLineTest, UsageMistakesNameTheArgumentAsItWasTyped) {
  expect_mistake("", "canyon: no verb given, expected one of compare, run, ");
  expect_mistake("frobnicate mission.toml", "canyon: \"frobnicate\" is not a verb, expected one of compare, run, ");
  expect_mistake("comapre", "; nearest is \"compare\"\n");
  expect_mistake("gnss", "canyon gnss: no verb given, expected one of sky, ");
  expect_mistake("gnss skie", "canyon gnss: \"skie\" is not a verb, expected one of sky, ");
  expect_mistake("run mission.toml --frobnicate",
                 "canyon run: no option \"--frobnicate\", expected one that canyon run --help names\n");
  expect_mistake("run mission.toml --output x", "canyon run: no option \"--output\", expected \"--out\"?\n");
  expect_mistake("run mission.toml x", "canyon run: \"x\" is one argument too many\n");
  expect_mistake("run mission.toml --out ''", "--out: \"\", expected another value\n");
  // One value with commas: the mission is not swallowed as a fidelity.
  expect_mistake("compare --fidelities low high mission.toml",
                 "canyon compare: \"mission.toml\" is one argument too many\n");
  expect_mistake("run mission.toml --threads two", "--threads: \"two\", expected a whole number from 0 to 1024\n");
  expect_mistake("run mission.toml --threads=-3", "--threads: \"-3\", expected a whole number from 0 to 1024\n");
  for (const char* seed : {"99999999999999999999999", "9000000000000001", "-1", "1.5", "x"})
    expect_mistake(std::string("run mission.toml --seed ") + seed,
                   std::string("--seed: \"") + seed + "\", expected a whole number from 0 to 9000000000000000\n");
  expect_mistake("run mission.toml --out", "canyon run: --out has no value, expected one\n");
  // 2026-11-30: "has no value", or the first one was blamed.
  expect_mistake("compare mission.toml --threads 1 --threads 2",
                 "canyon compare: --threads given twice, expected it once\n");
  expect_mistake("compare mission.toml --threads 1 --threads 2 --threads x",
                 "canyon compare: --threads given 3 times, expected it once\n");
  expect_mistake("gnss solve --obs a --nav b --nav ''", "--nav: \"\", expected another value\n");
  // 2026-11-30: "expected another value".
  expect_mistake("lidar scan --frame world", "--frame: \"world\", expected one of sensor, scene\n");
  expect_mistake("lidar error-budget --hidden=heeled",
                 "--hidden: \"heeled\", expected one of healed, dropped, both; nearest is \"healed\"\n");
  // 2026-11-22: "is missing, expected it".
  expect_mistake("report", "canyon report: directory is missing; canyon report --help shows an example\n");
}

// 2026-11-30: nan passed every range, to end a computation in a check, or a drive in garbage.
TEST_F(CommandLineTest, WhatIsNoNumberIsInNoRange) {
  for (const char* none : {"nan", "NaN", "nan(7)", "inf", "1e999"})
    expect_mistake("lidar evaluate map.pcd --cap '" + std::string(none) + "'",
                   "--cap: \"" + std::string(none) + "\", expected a number from 0.1 to 100\n");
  expect_mistake("lidar evaluate map.pcd --cap=-nan", "--cap: \"-nan\", expected a number from 0.1 to 100\n");
  expect_mistake("lidar evaluate map.pcd --trajectory a.tum --estimate b.tum --estimate-rate nan",
                 "--estimate-rate: \"nan\", expected a number from 0.001 to 10000\n");
  expect_mistake("lidar evaluate map.pcd --trajectory a.tum --reach nan",
                 "--reach: \"nan\", expected a number from 1 to 1000\n");
  expect_mistake("lidar register a.bin b.bin --leaf nan", "--leaf: \"nan\", expected a number from 0.01 to 100\n");
  expect_mistake("lidar error-response --stretch nan", "--stretch: \"nan\", expected a number from 10 to 100000\n");
  expect_mistake("compare --open-loop --trajectory x --trajectory-rate nan",
                 "--trajectory-rate: \"nan\", expected a number from 0.001 to 10000\n");
  expect_mistake("scene info a.obj --undulation nan", "--undulation: \"nan\", expected a number from -200 to 200\n");
  // Those that are read in their own way.
  for (const char* none : {"nan", "inf"}) {
    const std::string word = none;
    expect_mistake("tolerance --sizes 1," + word,
                   "--sizes: \"" + word + "\", expected numbers from 0 to 1000, apart by commas\n");
    expect_mistake("lidar error-response --sizes 1," + word,
                   "--sizes: \"" + word + "\", expected numbers above 0, up to 1000, apart by commas\n");
    expect_mistake("lidar register a.bin b.bin --sigma " + word + ",1",
                   "--sigma: \"" + word + ",1\" cannot be read, expected METRES,DEGREES: of the guess, per axis\n");
    expect_mistake("lidar register a.bin b.bin --guess=1,0,0,0,0,1,0,0,0,0,1,0,0,0,0," + word,
                   "\" cannot be read, expected 16 numbers, row by row: T_target_source\n");
    expect_mistake("lidar scan --at 0,0,0," + word,
                   "--at: \"0,0,0," + word + "\" cannot be read, expected X,Y,H,YAW: ");
    expect_mistake("lidar scan --at 0,0,0,0 --rate " + word,
                   "--rate: lidar.rate_hz: " + word + " is not a finite number, expected a number from 0.1 to 100\n");
    expect_mistake("tradeoff --budget-cpu " + word, "--budget-cpu: " + word + ", expected a positive number\n");
  }
}

// 2026-11-30: --set won, silently.
TEST_F(CommandLineTest, AKeyThatHasAnOptionIsSetByOneOfThem) {
  expect_mistake("run mission.toml --seed 6 --set run.seed=5 --out out",
                 "--seed: stands beside --set run.seed, expected one of the two\n");
  expect_mistake("run mission.toml --set 'run={seed=5}' --seed 6 --out out",
                 "--seed: stands beside --set run.seed, expected one of the two\n");
  expect_mistake("compare mission.toml --nav a.10n --set 'gnss.nav_file=\"b.10n\"' --out out",
                 "--nav: stands beside --set gnss.nav_file, expected one of the two\n");
  expect_mistake("plan mission.toml --start 1590:0 --set 'time.start=\"1591:0\"'",
                 "--start: stands beside --set time.start, expected one of the two\n");
}

TEST_F(CommandLineTest, PathsInAMissionFileStartAtItsFolder) {
  fs::create_directories(folder_ / "given_place");
  write("given_place/my.toml", std::string(kMission) + "[imu]\nsensor = \"my_imu.toml\"\n");
  expect_mistake("run given_place/my.toml --out out",
                 "given_place/my.toml:15: imu.sensor: \"given_place/my_imu.toml\" cannot be read (No such file or "
                 "directory), expected a readable file\n");
  std::string quiet = "name = \"mine\"\n[gyro]\n";
  for (const char* key :
       {"arw_deg_per_sqrt_hr", "turn_on_bias_deg_per_hr", "in_run_bias_deg_per_hr", "scale_ppm", "misalignment_mrad"})
    quiet += std::string(key) + " = 0\n";
  quiet += "[accel]\n";
  for (const char* key : {"vrw_m_s_per_sqrt_hr", "turn_on_bias_mg", "in_run_bias_mg", "scale_ppm", "misalignment_mrad"})
    quiet += std::string(key) + " = 0\n";
  write("given_place/my_imu.toml", quiet);
  ASSERT_EQ(canyon("run given_place/my.toml --fidelity low --out out"), 0) << read("stderr");
  const auto manifest = nlohmann::json::parse(read("out/manifest.json"));
  EXPECT_EQ(manifest["files"]["given_place/my_imu.toml"].get<std::string>().size(), 64U);
  EXPECT_EQ(manifest["files"].size(), 1U);
  // Both places are told in full.
  EXPECT_THAT(read("stdout"), HasSubstr("\nResults: " + path("out") + "\nReport:  " + path("out/report.html") + "\n"));
  EXPECT_THAT(read("stdout"), HasSubstr(", limit 4 s\n"));
}

TEST_F(CommandLineTest, KeysPrintsTheReference) {
  ASSERT_EQ(canyon("keys"), 0);
  EXPECT_THAT(read("stdout"), HasSubstr("\n## [gnss]: the GNSS receiver and its errors\n"));
  ASSERT_EQ(canyon("keys --json"), 0);
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_GT(json["keys"].size(), 100U);
  EXPECT_EQ(json["keys"][0]["key"].get<std::string>().rfind("scene.", 0), 0U);
  ASSERT_EQ(canyon("keys --figures"), 0);
  EXPECT_THAT(read("stdout"), HasSubstr("| `map_error_rms_m` | map error, registered, RMS | m | lower |\n"));
  ASSERT_EQ(canyon("keys --figures --json"), 0);
  EXPECT_EQ(nlohmann::json::parse(read("stdout"))["figures"][0]["key"], "waypoints_reached");
}

TEST_F(CommandLineTest, HelpShowsDefaultsAndAnExample) {
  ASSERT_EQ(canyon("--help"), 0);
  EXPECT_THAT(read("stdout"), HasSubstr("canyon compare --out first"));
  ASSERT_EQ(canyon("compare --help"), 0);
  EXPECT_THAT(read("stdout"), HasSubstr("low,high,paper"));
  EXPECT_THAT(read("stdout"), ::testing::ContainsRegex("--threads INT:INT in .0 - 1024.=0|--threads.*=0"));
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
  for (const char* verb : {"compare", "run", "report", "keys"}) {
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
