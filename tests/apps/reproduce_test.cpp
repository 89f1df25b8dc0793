// `canyon reproduce` as it is typed.
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ReproduceTest : public CommandLineTest {};

/// Figure 8 has the scene: the mission's one waypoint, at which it looks, and buildings' closed outlines. Figures 9 and
/// 10 have every track twice, from above and as heights at the same instants; of what is no fix one a second.
void expect_drawings(const nlohmann::json& curves) {
  std::map<std::string, nlohmann::json> scene, above, height;
  for (const auto& curve : curves) {
    const auto panel = curve["panel"].get<std::string>();
    auto& of = panel.find("Fig. 8") == 0 ? scene : curve["from_above"].get<bool>() ? above : height;
    of[curve["name"].get<std::string>()] = curve;
  }
  EXPECT_EQ(scene["mission waypoints"]["labels"], nlohmann::json::array({"house"}));
  EXPECT_EQ(scene["mission waypoints"]["x"], nlohmann::json::array({213.9}));
  EXPECT_EQ(scene["mission waypoints"]["y"], nlohmann::json::array({150.0}));
  EXPECT_GT(scene["planned route"]["x"].size(), 2u);
  const auto &x = scene["buildings"]["x"], &y = scene["buildings"]["y"];
  std::size_t outlines = 0;
  for (std::size_t first = 0, i = 0; i < x.size(); ++i) {
    if (!x[i].is_null()) continue;
    ASSERT_GT(i, first + 3) << "three corners, and the first again";
    EXPECT_TRUE(x[i - 1] == x[first] && y[i - 1] == y[first]) << first;
    ++outlines;
    first = i + 1;
  }
  EXPECT_GT(outlines, 272u) << "there is a building 273";

  ASSERT_EQ(height.size(), 6u);
  ASSERT_EQ(above.size(), height.size());
  for (const auto& [name, heights] : height) {
    EXPECT_GT(heights["x"].size(), 2u) << name;
    EXPECT_EQ(heights["x"].size(), above[name]["x"].size()) << name;
    if (heights["points"].get<bool>()) continue;
    // The first epoch comes a tenth of a second after the start.
    for (std::size_t i = 0; i < heights["x"].size(); ++i)
      EXPECT_EQ(heights["x"][i], i == 0 ? 0.1 : static_cast<double>(i)) << name;
  }
}

TEST_F(ReproduceTest, WritesThePageAndTheNumbers) {
  ASSERT_EQ(canyon("reproduce --draws 1 --out paper"), 0) << read("stderr");
  EXPECT_THAT(read("stdout"), HasSubstr("Table 1 and Fig. 1"));
  EXPECT_THAT(read("stdout"), HasSubstr("satellites: the built-in constellation, systems G, from 2010-11-17T13:00:00"));
  EXPECT_THAT(read("paper/report.html"), HasSubstr("<h1>Durst &amp; Goodin 2012, beside ours</h1>"));
  EXPECT_THAT(read("paper/summary.json"), HasSubstr("\"name\": \"table_2\""));
  EXPECT_THAT(read("paper/paper.csv"), HasSubstr("table_1,\"ionosphere\",m,4.73,,\"as printed, ranges alone, raw\","));
  const std::string page = read("paper/report.html");
  EXPECT_THAT(page, HasSubstr("Numbers are medians over 1\xC2\xA0"
                              "draw with"));
  EXPECT_THAT(page, HasSubstr("Fig. 6: circle of 30 ft, eight loops, from above"));
  EXPECT_EQ(canyon("report paper"), 0) << read("stderr");
  EXPECT_EQ(read("paper/report.html"), page);
}

TEST_F(ReproduceTest, DrivesTheMissionToo) {
  ASSERT_EQ(canyon("reproduce mission.toml --draws 1 --missions 2 --out paper"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("paper/summary.json"));
  ASSERT_EQ(json["parts"].size(), 7u);
  const auto& mission = json["parts"][5];
  EXPECT_EQ(mission["name"], "figures_8_to_10");
  const auto& share = mission["rows"][0];
  ASSERT_EQ(share["ours"].size(), 4u);
  EXPECT_EQ(share["ours"][0]["form"], "low");
  EXPECT_EQ(share["ours"][3]["form"], "high less low");
  // Its time limit stops every run: whether one would have succeeded is not known.
  for (const auto& ours : share["ours"]) {
    for (const char* what : {"value", "low", "high"}) EXPECT_TRUE(ours[what].is_null()) << ours["form"] << ' ' << what;
  }
  expect_drawings(mission["curves"]);
  // Of localization five, and five of obstacles, ways and what is hit.
  ASSERT_EQ(json["parts"][6]["rows"].size(), 10u);
  int have = 0;
  for (const auto& row : json["parts"][6]["rows"]) {
    ASSERT_EQ(row["ours"].size(), 4u) << row["what"];
    EXPECT_EQ(row["ours"][3]["form"], "high less low");
    EXPECT_TRUE(row["ours"][0]["low"].is_null()) << row["what"] << ": two seeds have no interval of the median";
    const bool defined = row["ours"][0]["value"].is_number();
    have += defined ? 1 : 0;
    for (const char* what : {"low", "value", "high"})
      ASSERT_EQ(row["ours"][3][what].is_number(), defined) << row["what"] << ' ' << what;
    if (!defined) continue;
    EXPECT_LE(row["ours"][3]["low"].get<double>(), row["ours"][3]["value"].get<double>()) << row["what"];
  }
  EXPECT_EQ(have, 8) << "the test's mission does not register";
  EXPECT_THAT(read("paper/report.html"), Not(HasSubstr("was not driven")));
}

TEST_F(ReproduceTest, MistakesAreOneLine) {
  EXPECT_EQ(canyon("reproduce --draws 0 --out paper"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("--draws"));
  EXPECT_EQ(canyon("reproduce --nav nothing.10n --out paper"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("nothing.10n"));
  EXPECT_EQ(canyon("reproduce --start soon --out paper"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("soon"));
  EXPECT_FALSE(std::filesystem::exists(path("paper"))) << "nothing is left";
}

}  // namespace
}  // namespace canyon::apps::testing
