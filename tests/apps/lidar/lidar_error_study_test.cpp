// canyon lidar error-events and canyon lidar error-response: as a user calls them.
#include <string>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using ErrorStudyJson = nlohmann::json;

class LidarErrorStudyTest : public testing::CommandLineTest {
 protected:
  void refused(const std::string& words, const std::string& line) {
    EXPECT_EQ(canyon("lidar " + words), 2) << words;
    const std::string said = read("stderr");
    EXPECT_NE(said.find(line), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_TRUE(read("stdout").empty());
  }
};

TEST_F(LidarErrorStudyTest, EventsLeaveTheirFiles) {
  ASSERT_EQ(canyon("lidar error-events mission.toml --fidelity low --seeds 1 --starts 2 --out given_events --json"), 0)
      << read("stderr");
  const ErrorStudyJson out = ErrorStudyJson::parse(read("stdout"));
  EXPECT_EQ(out["starts"], 2);
  EXPECT_EQ(out["registered"], false);
  EXPECT_EQ(out["kinds"].size(), 5U);
  EXPECT_EQ(out["kinds"]["estimate_jump"]["events"], 0);
  EXPECT_TRUE(out["kinds"]["estimate_jump"]["map_prior"]["effect"]["value_m"].is_null());
  EXPECT_EQ(read("given_events/error_events.csv").rfind("kind,series,lag_s,event,event_low,event_high,placebo,", 0),
            0U);
  EXPECT_NE(read("given_events/report.html").find("estimate_jump"), std::string::npos);
  EXPECT_EQ(canyon("report given_events"), 0) << read("stderr");
}

TEST_F(LidarErrorStudyTest, ResponseLeavesItsFiles) {
  ASSERT_EQ(canyon("lidar error-response mission.toml --fidelity low --set time.limit_s=10 --set "
                   "registration.submap_keyframes=2 --methods none --errors jump_m --sizes 1,2 --out given_response "
                   "--json"),
            0)
      << read("stderr");
  const ErrorStudyJson out = ErrorStudyJson::parse(read("stdout"));
  EXPECT_EQ(out["curves"].size(), 3 * (1 + out["places_from_m"].size()));
  const auto& points = out["curves"][0]["keyframe"]["points"];
  EXPECT_NEAR(points[1]["prior_m"].get<double>(), 2.0, 1e-9);
  EXPECT_EQ(points[1]["healed"], 0.0);
  EXPECT_EQ(out["curves"][0]["keyframe"]["half_healed_up_to"], 0.0);
  EXPECT_EQ(read("given_response/error_response.csv").rfind("method,kind,axis,from_m,size,series,", 0), 0U);
  EXPECT_NE(read("given_response/report.html").find("jump_m, forward"), std::string::npos);
  EXPECT_EQ(canyon("report given_response"), 0) << read("stderr");
}

TEST_F(LidarErrorStudyTest, BadInputsAreOneLine) {
  refused("error-events mission.toml --fidelity hihg", "hihg");
  refused("error-events mission.toml --starts 1", "--starts");
  refused("error-response mission.toml --methods gicpp", "--methods: unknown name \"gicpp\"");
  refused("error-response mission.toml --errors jump", "--errors: unknown name \"jump\"");
  refused("error-response mission.toml --sizes 1,0", "--sizes: \"0\"");
  refused("error-response mission.toml --methods none --errors jump_m --out given_none", "--stretch: 100 m: the route");
  EXPECT_TRUE(leftovers().empty());
}

}  // namespace
}  // namespace canyon::apps
