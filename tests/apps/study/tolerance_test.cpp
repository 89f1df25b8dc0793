// canyon tolerance as it is typed: its table, its files and its mistakes.
#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::json;

/// Sixty metres up a street, by who steers by the pose alone.
constexpr const char* kSixtyMetres = R"(base = "vicksburg"
[run]
seed = 7
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[registration]
method = "none"
[autonomy]
model = "route_follower"
[[autonomy.waypoint]]
name = "goal"
p_m = [213.9, 90.0]
)";

class ToleranceVerbTest : public CommandLineTest {
 protected:
  void SetUp() override {
    CommandLineTest::SetUp();
    write("mission.toml", kSixtyMetres);
  }
};

// Of 2 out of 2 and of 0 out of 2 the intervals of Wilson are 1 / (1 + z^2 / 2) to 1 and 0 to 1 - 1 / (1 + z^2 / 2), z
// = 1.96.
TEST_F(ToleranceVerbTest, TellsHowOftenAMissionSucceedsAtEachSize) {
  ASSERT_EQ(canyon("tolerance mission.toml --error drift_m_s --sizes 0.01,3 --seeds 2 --out out"), 0) << read("stderr");
  const std::string table = read("stdout");
  EXPECT_THAT(table, StartsWith("drift_m_s, fidelity low, autonomy route_follower, seeds from 7 on\n"
                                "        size    success  95 %            how the others ended\n"
                                "        0.01     2 / 2    0.34 to 1.00    \n"
                                "           3     0 / 2    0.00 to 0.66    "));
  EXPECT_THAT(table, HasSubstr("\nWithin their intervals, larger errors never succeed more often.\n"));
  EXPECT_THAT(table, HasSubstr("\nResults: " + path("out") + "\n"));

  Json summary = Json::parse(read("out/summary.json"));
  EXPECT_EQ(summary["error"], "drift_m_s");
  EXPECT_EQ(summary["fidelity"], "low");
  EXPECT_EQ(summary["autonomy"], "route_follower");
  EXPECT_EQ(summary["first_seed"], 7);
  EXPECT_EQ(summary["monotone"], true);
  ASSERT_EQ(summary["points"].size(), 2U);
  Json &small = summary["points"][0], &large = summary["points"][1];
  EXPECT_EQ(small["size"], 0.01);
  EXPECT_EQ(small["success"], 2);
  EXPECT_EQ(small["n"], 2);
  EXPECT_EQ(small["outcomes"], (Json{"success", "success"}));
  EXPECT_EQ(large["size"], 3.0);
  EXPECT_EQ(large["success"], 0);
  EXPECT_EQ(large["n"], 2);
  EXPECT_EQ(large["outcomes"].size(), 2U);
  constexpr double kLow = 0.342380, kRounded = 5e-7;
  EXPECT_NEAR(small["low"].get<double>(), kLow, kRounded);
  EXPECT_NEAR(small["high"].get<double>(), 1.0, kRounded);
  EXPECT_NEAR(large["low"].get<double>(), 0.0, kRounded);
  EXPECT_NEAR(large["high"].get<double>(), 1.0 - kLow, kRounded);

  const std::string csv = read("out/tolerance.csv");
  EXPECT_THAT(csv, StartsWith("size,success,n,low,high\n0.01,2,2,0.34238"));
  EXPECT_THAT(csv, HasSubstr("\n3,0,2,0"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
}

TEST_F(ToleranceVerbTest, WhatItsTimeLimitStoppedHasNoShare) {
  ASSERT_EQ(
      canyon("tolerance mission.toml --error height_m --sizes 1,10 --seeds 2 --set time.limit_s=1 --json --out out"), 0)
      << read("stderr");
  EXPECT_EQ(read("stderr"), "");
  Json told = Json::parse(read("stdout"));  // exactly one object
  EXPECT_EQ(told["results_dir"], "out");
  told.erase("results_dir");
  EXPECT_EQ(told, Json::parse(read("out/summary.json")));
  for (const Json& point : told["points"]) {
    EXPECT_EQ(point.at("n"), 0);
    EXPECT_TRUE(point.at("low").is_null());
    EXPECT_TRUE(point.at("high").is_null());
    EXPECT_EQ(point.at("outcomes"), (Json{"stopped", "stopped"}));
  }
  EXPECT_EQ(read("out/tolerance.csv"), "size,success,n,low,high\n1,0,0,,\n10,0,0,,\n");
}

TEST_F(ToleranceVerbTest, Mistakes) {
  for (const char* word : {"x", "-1", "1001", "nan", "3m"})
    expect_mistake(std::string("tolerance mission.toml --sizes 1,") + word + " --out out",
                   std::string("--sizes: \"") + word + "\", expected numbers from 0 to 1000, apart by commas\n");
  expect_mistake("tolerance mission.toml --error hight_m --out out",
                 "--error: unknown name \"hight_m\", expected one of \"white_fix_m\", \"step_m\", \"drift_m_s\", "
                 "\"heading_deg\", \"height_m\"; nearest is \"height_m\"\n");
  expect_mistake("tolerance mission.toml --fidelity lo --out out", "--fidelity: \"lo\" is unknown, ");
  expect_mistake("tolerance mission.toml --seeds 0 --out out",
                 "--seeds: \"0\", expected a whole number from 1 to 10000\n");
}

}  // namespace
}  // namespace canyon::apps::testing
