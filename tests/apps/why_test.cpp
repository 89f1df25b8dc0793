// compare --why through the binary: what is said of a run that failed, and of how it is asked.
#include <cstdio>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class WhyTest : public CommandLineTest {};

/// A vehicle that sees nothing, takes nothing for free, and so stands until it counts as stuck.
std::string blind_mission() {
  std::string text = kMission;
  text.replace(text.find("limit_s = 4.0"), 13, "limit_s = 60.0");
  return text +
         "[autonomy.speed]\nassumed_seen_m = 0.0\n[success]\nstuck_after_s = 5.0\n"
         "[lidar]\nblinded = true\n";
}

// No source of error is to blame for who does not drive whatever it believes.
TEST_F(WhyTest, AMissionThatNobodyCouldFinishIsNotBlamedOnNavigation) {
  write("mission.toml", blind_mission());
  ASSERT_EQ(canyon("compare mission.toml --fidelities low --no-2x2 --why --why-draws 10 --out out"), 0)
      << read("stderr");
  EXPECT_THAT(read("stdout"),
              HasSubstr("Why low failed: navigation is not to blame. Told its true position it succeeds in 0 of 10 "
                        "repeats, so in at most 28 % of such drives (95 %); with nothing but the noise changed from "
                        "0.0 s on, in 0 of 10."));
  const Json why = Json::parse(read("out/why.json"));
  ASSERT_EQ(why["failures"].size(), 1U);
  const Json& failure = why["failures"][0];
  EXPECT_EQ(failure["run"], "low");
  EXPECT_EQ(failure["draws"], 10);
  EXPECT_TRUE(failure["cause"].is_null());
  EXPECT_EQ(failure["removals"].size(), 8U);
  for (const Json& removal : failure["removals"]) {
    EXPECT_EQ(removal["success"], 0);
    EXPECT_EQ(removal["p"], 1.0);
    EXPECT_EQ(removal["rescues"], false);
  }
  EXPECT_THAT(read("stdout"), HasSubstr(" s: it got stuck (stood still for 5.0 s)\n"));
  EXPECT_FALSE(why.contains("tally")) << "of one seed there is nothing to count";
  EXPECT_THAT(read("out/report.html"), HasSubstr("navigation is not to blame. Told its true position it succeeds in 0 "
                                                 "of 10 repeats, so in at most 28 % of such drives (95 %); "));
  // The same question again, on another number of threads: the same answer.
  ASSERT_EQ(canyon("compare mission.toml --fidelities low --no-2x2 --why --why-draws 10 --threads 1 --out again"), 0);
  EXPECT_EQ(read("again/why.json"), read("out/why.json"));
}

// A vehicle that follows its estimate alone, and one that stands across the street, twelve metres on. 2026-11-29: what
// was said of it was "collision, hit car".
TEST_F(WhyTest, ACollisionIsToldInTheSameWordsEverywhere) {
  std::string text = kMission;
  text.replace(text.find("limit_s = 4.0"), 13, "limit_s = 60.0");
  text.replace(text.find("[autonomy]\n"), 11, "[autonomy]\nmodel = \"route_follower\"\n");
  write("mission.toml", text +
                            "[[scene.moving]]\nname = \"broken down\"\npath_m = [213.9, 45.0, 214.9, 45.0]\n"
                            "start_s = 1e5\n");
  ASSERT_EQ(canyon("compare mission.toml --fidelities low --no-2x2 --why --why-draws 10 --out out"), 0)
      << read("stderr");
  const std::string hit = "it hit another vehicle (broken down)";
  EXPECT_THAT(read("stdout"), HasSubstr(" s: " + hit)) << "the chain";
  EXPECT_THAT(read("stdout"), HasSubstr(" m: " + hit)) << "the table";
  const Json failure = Json::parse(read("out/why.json"))["failures"][0];
  EXPECT_EQ(failure["outcome"], "collision");
  EXPECT_EQ(failure["detail"], "hit other vehicle broken down");
  EXPECT_THAT(failure["chain"].back().get<std::string>(), HasSubstr(" s: " + hit + ", "));
  EXPECT_THAT(read("out/report.html"), HasSubstr(" failed: " + hit + ", ")) << "the verdict";
  EXPECT_THAT(read("out/report.html"), HasSubstr(" s: " + hit)) << "its chain";
}

// What a time limit stopped has not failed, and is not asked about.
TEST_F(WhyTest, AStoppedRunIsNotExplained) {
  ASSERT_EQ(canyon("compare mission.toml --fidelities low --no-2x2 --why --why-draws 10 --out out"), 0)
      << read("stderr");
  EXPECT_EQ(Json::parse(read("out/why.json"))["failures"].size(), 0U);
  // 2026-11-30: nothing was said.
  EXPECT_THAT(read("stdout"), HasSubstr("\nNo run failed, so there is nothing to explain.\n"));
}

TEST_F(WhyTest, Mistakes) {
  expect_mistake("compare mission.toml --why-draws 10 --out out",
                 "--why-draws: is for replays, expected --why beside it\n");
  expect_mistake("compare mission.toml --why --open-loop --out out",
                 "--why: an open loop has no outcome, expected no --open-loop beside it\n");
  expect_mistake("compare mission.toml --why --plan=none.plan --out out",
                 "--why: replays leave nothing out by a plan, expected no --plan beside it\n");
  expect_mistake("compare mission.toml --why --why-draws 9 --out out",
                 "--why-draws: \"9\", expected a whole number from 10 to 1000\n");
  expect_mistake("compare mission.toml --why --why-draws 1001 --out out",
                 "--why-draws: \"1001\", expected a whole number from 10 to 1000\n");
  expect_mistake("compare mission.toml --seeds 2 --why --why-seeds 0 --out out",
                 "--why-seeds: \"0\", expected a whole number from 1 to 100000\n");
  expect_mistake("compare mission.toml --seeds 2 --why-seeds 1 --out out",
                 "--why-seeds: is for replays, expected --why beside it\n");
  expect_mistake("compare mission.toml --why --why-seeds 1 --out out",
                 "--why-seeds: is for failures of several seeds, expected --seeds beside it\n");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

}  // namespace
}  // namespace canyon::apps::testing
