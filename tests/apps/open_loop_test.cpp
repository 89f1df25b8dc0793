// compare --open-loop through the binary: a run's own tape, a drive of somebody's, and what is wrong with either.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class OpenLoopTest : public CommandLineTest {
 protected:
  /// Five seconds straight up the street at 2 m/s, ten poses a second; changed by `pose` (number, x, y).
  void write_drive(const std::string& name, int poses, const std::function<void(int, double&, double&)>& change = {}) {
    std::string text;
    for (int k = 0; k < poses; ++k) {
      double x = 213.9, y = 30.0 + 0.2 * k;
      if (change) change(k, x, y);
      char line[120];
      std::snprintf(line, sizeof line, "%.1f %.3f %.3f 5.6 0 0 0.70710678 0.70710678\n", 0.1 * k, x, y);
      text += line;
    }
    write(name, text);
  }
  void expect_refusal(const std::string& arguments, const std::string& words) {
    EXPECT_EQ(canyon("compare mission.toml --fidelities low --no-2x2 --out out " + arguments), 2) << arguments;
    EXPECT_EQ(read("stderr"), words + "\n");
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }
};

TEST_F(OpenLoopTest, ARunOnItsOwnTapeIsThatRunBitForBit) {
  ASSERT_EQ(canyon("run mission.toml --fidelity low --out drive"), 0) << read("stderr");
  ASSERT_EQ(canyon("compare mission.toml --open-loop --tape drive --fidelities low,high --no-2x2 --out again --json"),
            0)
      << read("stderr");
  for (const char* file : {"epochs/low_nav.csv", "epochs/low_gnss.csv", "epochs/low_satellites.csv",
                           "epochs/low_keyframes.csv", "clouds/low_prior.pcd"})
    EXPECT_EQ(read(std::string("again/") + file), read(std::string("drive/") + file)) << file;
  const Json summary = Json::parse(read("stdout"));
  EXPECT_EQ(summary["loop"]["kind"], "open");
  EXPECT_EQ(summary["loop"]["tape"], "low of vicksburg");
  EXPECT_EQ(summary["loop"]["paired_epochs"][0]["epochs"], 40);
  for (const Json& run : summary["runs"]) {
    EXPECT_TRUE(run["outcome"].is_null());
    EXPECT_TRUE(run["waypoints_reached"].is_null());
    EXPECT_EQ(run["distance_m"], summary["runs"][0]["distance_m"]);
  }
}

/// What does not depend on the machine.
Json untimed(Json runs) {
  for (Json& run : runs)
    for (const char* key : {"timing", "real_time_factor", "cpu_s"}) run.erase(key);
  return runs;
}

TEST_F(OpenLoopTest, BothLoopsSideBySideAreEachByItself) {
  const std::string compare = "compare mission.toml --fidelities low,high --no-2x2 --seeds 2 --json --out ";
  Json both, open, closed;
  for (auto [arguments, answer] :
       {std::pair{"both --both-loops", &both}, std::pair{"open --open-loop", &open}, std::pair{"closed", &closed}}) {
    ASSERT_EQ(canyon(compare + arguments), 0) << read("stderr");
    *answer = Json::parse(read("stdout"));
  }
  EXPECT_EQ(untimed(both["runs"]), untimed(closed["runs"]));
  EXPECT_EQ(both["shares"], closed["shares"]);
  EXPECT_EQ(both["loop"]["kind"], "closed");
  const Json& beside = both["open_loop"];
  EXPECT_EQ(untimed(beside["runs"]), untimed(open["runs"]));
  EXPECT_EQ(beside["runs"].size(), 4U);
  double cpu_s = 0.0;
  for (const Json& runs : {both["runs"], beside["runs"]})
    for (const Json& run : runs) cpu_s += run["cpu_s"].get<double>();
  EXPECT_NEAR(both["timing"]["cpu_s"].get<double>(), cpu_s, 1e-9 * cpu_s);
  EXPECT_EQ(beside["paired_epochs"], open["loop"]["paired_epochs"]);
  EXPECT_EQ(beside["tape"], open["loop"]["tape"]);
  EXPECT_EQ(beside["duration_s"], 4.0);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_EQ(beside["over_seeds"][k]["figures"], open["over_seeds"][k]["figures"]) << k;
  EXPECT_NE(both["runs"][1]["position_error_rms_m"], beside["runs"][1]["position_error_rms_m"]);

  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --no-2x2 --both-loops --out table"), 0);
  EXPECT_THAT(read("stdout"),
              ::testing::ContainsRegex("low, closed +open +high, closed +open\nboth loops, side by side"));
  EXPECT_THAT(read("stdout"), ::testing::ContainsRegex("outcome +stopped +- +stopped +-\n"));
  EXPECT_THAT(read("stdout"), HasSubstr("open: all on one true motion (the route, driven on truth, 4 s)"));
  EXPECT_THAT(read("table/report.html"), HasSubstr("<h2 id=\"loops-h\">Closed and open loop</h2>"));
}

TEST_F(OpenLoopTest, BothLoopsLeaveMixedRunsToTheClosedOne) {
  ASSERT_EQ(canyon("compare mission.toml --fidelities low,high --seeds 2 --both-loops --json --out out"), 0)
      << read("stderr");
  const Json both = Json::parse(read("stdout"));
  EXPECT_EQ(both["runs"].size(), 8U);
  ASSERT_EQ(both["open_loop"]["runs"].size(), 4U);
  for (const Json& run : both["open_loop"]["runs"]) EXPECT_EQ(run["gnss"], run["imu"]);
}

TEST_F(OpenLoopTest, BothLoopsRefuseWhatIsForOne) {
  expect_refusal("--both-loops --open-loop",
                 "--both-loops: drives the closed loop too, expected no --open-loop beside it");
  expect_refusal("--both-loops --plan", "--both-loops: a plan is for one loop, expected no --plan beside it");
}

TEST_F(OpenLoopTest, SomebodysDriveIsTheTrueMotion) {
  write_drive("drive.tum", 51);
  ASSERT_EQ(
      canyon("compare mission.toml --open-loop --trajectory drive.tum --fidelities low --no-2x2 --out out --json"), 0)
      << read("stderr");
  const Json summary = Json::parse(read("stdout"));
  EXPECT_EQ(summary["loop"]["tape"], "drive.tum");
  // 2 m/s for the 4 s of time.limit_s; the file has millimetres.
  EXPECT_NEAR(summary["runs"][0]["distance_m"].get<double>(), 8.0, 2e-3);
}

TEST_F(OpenLoopTest, WhatIsWrongWithATapeIsSaid) {
  ASSERT_EQ(canyon("run mission.toml --fidelity low --out drive"), 0) << read("stderr");
  expect_refusal("--tape drive", "--tape: is for open loops, expected --open-loop beside it");
  write("cut.tape", read("drive/tapes/low.tape").substr(0, 3000));
  expect_refusal("--open-loop --tape cut.tape", "cut.tape: ends within a node, expected a tape that canyon wrote");

  // Before anything is driven.
  expect_refusal("--both-loops --tape cut.tape", "cut.tape: ends within a node, expected a tape that canyon wrote");

  const std::string mission = read("mission.toml");
  write("mission.toml", std::string(mission).replace(mission.find("4.0"), 3, "8.0"));
  expect_refusal("--open-loop --tape drive",
                 "drive/tapes/low.tape: is 4 s long, expected at least the 8 s of time.limit_s");
  write("mission.toml", std::string(mission).insert(mission.find("[time]"), "[scene]\nterrain_cell_m = 9.0\n"));
  EXPECT_EQ(canyon("compare mission.toml --open-loop --tape drive --out out"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("drive/tapes/low.tape: was recorded in another scene, expected a tape of this "
                                        "mission's scene ("));
}

TEST_F(OpenLoopTest, WhatIsWrongWithADriveIsSaid) {
  expect_refusal("--open-loop --trajectory-rate 5", "--trajectory-rate: stands alone, expected --trajectory beside it");
  write_drive("short.tum", 20);
  expect_refusal("--open-loop --trajectory short.tum",
                 "short.tum: is 1.9 s long, expected at least the 4 s of time.limit_s");
  write_drive("outside.tum", 51, [](int, double& x, double&) { x = 21390.0; });
  expect_refusal("--open-loop --trajectory outside.tum",
                 "outside.tum: leaves the scene at 0.0 s, x 21390.0 m, y 30.0 m, expected x from -500 to 500, y from "
                 "-500 to 500");
  write_drive("jump.tum", 51, [](int k, double&, double& y) { y += k >= 30 ? 40.0 : 0.0; });
  EXPECT_EQ(canyon("compare mission.toml --open-loop --trajectory jump.tum --out out"), 2);
  EXPECT_THAT(read("stderr"), ::testing::MatchesRegex("jump.tum: jumps by [0-9.]+ m at [0-9.]+ s, x 213.9 m, y [0-9.]+ "
                                                      "m, expected the path of a ground vehicle\n"));
}

}  // namespace
}  // namespace canyon::apps::testing
