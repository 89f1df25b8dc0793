// canyon lidar error-budget, error-events and error-response: as a user calls them.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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

/// Shares of one figure add up to total - floor, to `relative` of the largest of these numbers.
void expect_all_shared(const std::string& figure, double total, double floor, const std::vector<double>& shares,
                       double relative) {
  double sum = 0.0, scale = std::max(std::abs(total), std::abs(floor));
  for (const double share : shares) sum += share, scale = std::max(scale, std::abs(share));
  EXPECT_NEAR(sum, total - floor, relative * scale + 1e-15) << figure;
}

// Few beams: some thirty runs of four seconds.
TEST_F(LidarErrorStudyTest, BudgetLeavesItsFilesAndSharesAllOfTheError) {
  ASSERT_EQ(
      canyon("lidar error-budget mission.toml --fidelity high --permutations 2 --set 'lidar.beams=\"grid:8:-15:5\"' "
             "--set lidar.azimuth_steps=360 --out given_budget --json"),
      0)
      << read("stderr");
  const ErrorStudyJson out = ErrorStudyJson::parse(read("stdout"));
  EXPECT_EQ(out["map"], "prior");
  EXPECT_EQ(out["seeds"], 1);
  EXPECT_EQ(out["permutations"], 2);
  EXPECT_GT(out["timing"]["cost_factor"].get<double>(), 1.0);
  // Sums of 9 shares, each the mean of two orders' differences of mean squares: some 40 eps, a hundred times.
  constexpr double kRounding = 1e-12;
  for (const char* hidden : {"hidden_healed", "hidden_dropped"}) {
    for (const char* figure : {"", "height", "keyframe", "keyframe_east", "keyframe_north", "keyframe_up",
                               "keyframe_roll", "keyframe_pitch", "keyframe_yaw"}) {
      const auto& of = *figure == '\0' ? out[hidden] : out[hidden][figure];
      const std::string unit = of.contains("total_m2") ? "_m2" : "_deg2";
      std::vector<double> shares;
      for (const auto& share : of["shares"]) {
        shares.push_back(share["share" + unit]);
        const std::string source = share["source"];
        if (source == "time_offset" || source == "guess") {
          EXPECT_EQ(shares.back(), 0.0) << "the mission is without " << source;
        }
      }
      EXPECT_EQ(shares.size(), out["sources"].size());
      expect_all_shared(figure, of["total" + unit].get<double>(), of["floor" + unit].get<double>(), shares, kRounding);
    }
  }
  EXPECT_EQ(out["total_m2"], out["hidden_healed"]["total_m2"]);
  EXPECT_GT(out["total_m2"].get<double>(), out["floor_m2"].get<double>());

  const ErrorStudyJson kept = ErrorStudyJson::parse(read("given_budget/summary.json"));
  EXPECT_EQ(kept["shares"], out["shares"]);

  std::istringstream csv(read("given_budget/error_budget.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "hidden,figure,unit,source,share,order_sigma,low,high,total,floor");
  std::map<std::string, std::vector<double>> shares;
  std::map<std::string, std::pair<double, double>> total_and_floor;
  while (std::getline(csv, line)) {
    std::vector<std::string> cells(1);
    for (const char c : line)
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    ASSERT_EQ(cells.size(), 10U) << line;
    const std::string figure = cells[0] + " " + cells[1];
    shares[figure].push_back(std::stod(cells[4]));
    total_and_floor[figure] = {std::stod(cells[8]), std::stod(cells[9])};
  }
  EXPECT_EQ(shares.size(), 2U * 9U);
  // Of 9 digits the last is off by a half, 5e-9 of a number that begins with 1, in each of 11 numbers.
  for (const auto& [figure, of] : shares) {
    EXPECT_EQ(of.size(), out["sources"].size()) << figure;
    expect_all_shared(figure, total_and_floor[figure].first, total_and_floor[figure].second, of, 5.5e-8);
  }

  const std::string page = read("given_budget/report.html");
  for (const char* words : {"Canyon: error budget", "Hidden signals healed", "Hidden signals dropped", "The sources",
                            "Map, distance to true surfaces", "multipath_nlos", "not in this mission"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_EQ(canyon("report given_budget"), 0) << read("stderr");
}

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
