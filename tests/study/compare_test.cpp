#include "canyon/study/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/process/progress.h"
#include "canyon/mission/run.h"
#include "canyon/tests/mission/memory_recorder.h"

namespace canyon::study {
namespace {

constexpr const char* kMission = R"(
base = "vicksburg"
[time]
limit_s = 6.0
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[registration]
method = "none"
[autonomy]
[[autonomy.waypoint]]
name = "house"
p_m = [213.9, 150.0]
observe = "building 273"
)";

class CompareTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto file = mission::MissionFile::parse(kMission, "my.toml");
    comparison_ = new Comparison(*prepare_comparison(*file, plan_runs({"low", "high"}, true)));
    results_ = new Results(*compare(*comparison_, "", false));
  }
  static void TearDownTestSuite() {
    delete results_;
    delete comparison_;
  }
  static Comparison* comparison_;
  static Results* results_;
};
Comparison* CompareTest::comparison_ = nullptr;
Results* CompareTest::results_ = nullptr;

TEST(PlanRuns, TwoByTwoAddsTheMixedRuns) {
  const auto plan = plan_runs({"low", "high", "paper"}, true);
  ASSERT_EQ(plan.size(), 5U);
  EXPECT_EQ(plan[3].name, "high_gnss_low_imu");
  EXPECT_EQ(plan[3].gnss, "high");
  EXPECT_EQ(plan[3].imu, "low");
  EXPECT_EQ(plan_runs({"low"}, false).size(), 1U);
  EXPECT_EQ(plan_runs({"mine", "low"}, true)[2].name, "low_gnss_mine_imu") << "of the first two, whichever they are";
}

TEST(TwoByTwoTest, IsOfTheFirstTwoFidelitiesCompared) {
  std::vector<RunSummary> runs(5);
  const char* sensors[][2] = {{"mine", "mine"}, {"low", "low"}, {"high", "high"}, {"low", "mine"}, {"mine", "low"}};
  for (std::size_t i = 0; i < 5; ++i) runs[i].gnss = sensors[i][0], runs[i].imu = sensors[i][1];
  const auto squares = two_by_two(runs);
  ASSERT_EQ(squares.size(), 1U);
  const TwoByTwo* square = &squares.front();
  EXPECT_EQ(square->levels, (std::array<std::string, 2>{"mine", "low"}));
  EXPECT_EQ(square->runs[0][1], &runs[4]);
  EXPECT_EQ(square->runs[1][0], &runs[3]);
  runs.pop_back();
  EXPECT_TRUE(two_by_two(runs).empty());
}

TEST(TwoByTwoTest, TheFilterIsAThirdFactor) {
  const auto plan = plan_runs({"low", "high"}, true, {"naive", "vehicle"});
  ASSERT_EQ(plan.size(), 8U);
  EXPECT_EQ(plan[3].name, "high_vehicle");
  EXPECT_EQ(plan[4].name, "high_gnss_low_imu_naive");
  std::vector<RunSummary> runs(plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i)
    runs[i].gnss = plan[i].gnss, runs[i].imu = plan[i].imu, runs[i].filter = plan[i].filter;
  const auto squares = two_by_two(runs);
  ASSERT_EQ(squares.size(), 2U);
  EXPECT_EQ(squares[0].filter, "naive");
  EXPECT_EQ(squares[1].runs[1][0], &runs[5]);
  runs.pop_back();  // of the vehicle's one cell is missing
  EXPECT_EQ(two_by_two(runs).size(), 1U);
}

TEST(TwoByTwoTest, ANamedFilterTakesThePlaceOfAllRows) {
  auto file = mission::MissionFile::parse(
      std::string(kMission) + "[fusion]\nstates = [\"biases\"]\nacceptance = \"huber\"\ngate_sigma = 4.0\n", "my.toml");
  const auto comparison = prepare_comparison(*file, plan_runs({"high"}, false, {"naive", "vehicle"}));
  ASSERT_TRUE(comparison.ok()) << comparison.error().str();
  const fusion::FilterParts vehicle = fusion::filter_parts(comparison->configs[1].fusion);
  EXPECT_EQ(vehicle.acceptance, "student_t");
  EXPECT_EQ(vehicle.states.size(), 6U);
  EXPECT_EQ(fusion::filter_parts(comparison->configs[0].fusion).acceptance, "gate");
}

TEST_F(CompareTest, AllRunsShareOneScene) {
  for (const auto& mission : comparison_->missions) EXPECT_EQ(mission.scene, comparison_->missions.front().scene);
}

TEST_F(CompareTest, RunsComeInTheOrderOfThePlan) {
  ASSERT_EQ(results_->records.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(results_->records[i].name, comparison_->plan[i].name);
}

// Paired by common random numbers: the low GNSS of the pure and of the mixed run draws the same errors, so that their
// first fixes, taken at nearly the same true place, have the same error to the bit of the draw.
TEST_F(CompareTest, PairedRunsShareTheirNoise) {
  const auto error = [&](std::size_t run) {
    mission::PreparedMission mission = comparison_->missions[run];
    mission.time_limit_s = 1.0;
    mission::testing::MemoryRecorder rows;
    const auto record = mission::run_mission(comparison_->configs[run], mission, nullptr,
                                             {.tape = nullptr, .recorder = &rows, .autonomy = nullptr});
    const auto& row = rows.gnss_rows.front();
    return Eigen::Vector3d(record->frame.to_W(row.fix.p_A_E) - row.p_A_W_true);
  };
  // ECEF positions of 6e6 m carry 1e-9 m.
  EXPECT_LT((error(0) - error(3)).norm(), 1e-8);  // low and low_gnss_high_imu
  EXPECT_LT((error(1) - error(2)).norm(),
            1e-3);  // high and high_gnss_low_imu: ranges to a place that differs by the loop
}

TEST_F(CompareTest, JsonHasTheContractsKeysAndNoNaN) {
  const auto json = summary_json(*results_);
  for (const auto& run : json["runs"]) {
    for (const char* key : {"fidelity", "outcome", "waypoints_reached", "mission_waypoints_reached", "distance_m",
                            "position_error_rms_m", "position_error_up_rms_m", "gdop_median", "gdop_max", "dop_jumps",
                            "nlos_share", "fixes_lost", "registration_error_rms_m", "registration_error_prior_rms_m",
                            "map_error_rms_m", "map_error_prior_rms_m", "map_error_up_rms_m", "map_error_p95_m"})
      EXPECT_TRUE(run.contains(key)) << key;
  }
  // The low model forms no pseudoranges: its DOP is undefined, not zero.
  EXPECT_TRUE(json["runs"][0]["gdop_median"].is_null());
  EXPECT_TRUE(json["runs"][0]["dop_jumps"].is_null());
  EXPECT_TRUE(json["runs"][1]["dop_jumps"].is_number());
  EXPECT_TRUE(json["runs"][1]["gdop_median"].is_number());
  EXPECT_EQ(json.dump().find("NaN"), std::string::npos);
  EXPECT_FALSE(json["two_by_two"].is_null());
  Results more = *results_;
  more.further_seeds = {more.summaries, more.summaries};
  const auto square = summary_json(more)["two_by_two"];
  EXPECT_FALSE(square.contains("outcome"));
  EXPECT_EQ(square["position_error_rms_m"], json["two_by_two"]["position_error_rms_m"]);
  for (std::size_t g = 0; g < 2; ++g)
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_EQ(square["successes"][g][i], json["two_by_two"]["outcome"][g][i] == "success" ? 3 : 0);
}

TEST_F(CompareTest, TableHasOneColumnPerRunAndARatio) {
  const std::string table = comparison_table(*results_);
  EXPECT_THAT(table, ::testing::HasSubstr("low"));
  EXPECT_THAT(table, ::testing::HasSubstr("high/low"));
  EXPECT_THAT(table, ::testing::HasSubstr("2 x 2, closed loop: outcome and position error RMS"));
  EXPECT_THAT(table, ::testing::HasSubstr("GDOP, median"));
  EXPECT_THAT(table, ::testing::Not(::testing::HasSubstr("nan")));
}

TEST_F(CompareTest, WithoutRegistrationNothingIsSaidOfIt) {
  const std::string table = comparison_table(*results_);
  EXPECT_THAT(table, ::testing::ContainsRegex("keyframes converged +- +- +-\n"));
  EXPECT_THAT(table, ::testing::ContainsRegex("keyframe error, registered, RMS, m +- +- +-\n"));
  EXPECT_THAT(table, ::testing::ContainsRegex("CPU time per simulated second, s +[0-9.]+ +[0-9.]+ +[0-9.]+\n"));
}

// A distance beyond the cap is not known; neither is a ratio of two such.
TEST_F(CompareTest, AMapErrorAtTheCapHasNoRatio) {
  Results results;
  results.mission = results_->mission;
  results.summaries = results_->summaries;
  results.summaries[0].prior_map.map_error_p95_m = lidar::kMapErrorCap_m;
  EXPECT_THAT(comparison_table(results), ::testing::ContainsRegex("map error, prior, 95 %, m +>= 5 +[0-9.]+ +-\n"));
  results.summaries[0].prior_map.map_error_p95_m = 2.0;
  results.summaries[1].prior_map.map_error_p95_m = 4.0;
  EXPECT_THAT(comparison_table(results), ::testing::ContainsRegex("map error, prior, 95 %, m +2.000 +4.000 +2.00\n"));
}

// What no GNSS model asks for is not made.
TEST(SceneCounters, FixesWithoutSatellitesNeedNoIndexOfFacetsOrEdges) {
  auto file = mission::MissionFile::parse(kMission, "my.toml");
  for (const char* fidelity : {"low", "high"}) {
    const auto comparison = prepare_comparison(*file, plan_runs({fidelity}, false));
    const auto results = compare(*comparison, "", false);
    const auto counters = summary_json(*results)["scene"]["counters"];
    EXPECT_EQ(counters["facets_indexed"] > 0, std::string(fidelity) == "high") << counters;
    EXPECT_EQ(counters["edges_indexed"] > 0, std::string(fidelity) == "high") << counters;
    EXPECT_EQ(counters["tiles"], 1);
    EXPECT_EQ(counters["acceleration_structures"], 1) << "nothing moves";
  }
}

TEST(PrepareComparison, ANameCannotStandForTwoRuns) {
  auto file = mission::MissionFile::parse(std::string(kMission) + "[fidelity.high_gnss_low_imu.gnss]\nrate_hz = 1.0\n",
                                          "my.toml");
  const auto comparison = prepare_comparison(*file, plan_runs({"low", "high", "high_gnss_low_imu"}, true));
  ASSERT_FALSE(comparison.ok());
  EXPECT_EQ(comparison.error().str(),
            "two runs would be named \"high_gnss_low_imu\", expected another name for the fidelity");
}

TEST(Cancel, StopsARunAtOnce) {
  auto file = mission::MissionFile::parse(kMission, "my.toml");
  const auto comparison = prepare_comparison(*file, plan_runs({"low"}, false));
  set_cancel_requested(true);
  EXPECT_THROW((void)compare(*comparison, "", false), Cancelled);
  set_cancel_requested(false);
}

}  // namespace
}  // namespace canyon::study
