// A run whose autonomy never returns, beside others of the same comparison.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/process/parallel.h"
#include "canyon/mission/recorder/run_files.h"
#include "canyon/mission/run.h"
#include "canyon/study/compare.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kFaultyDrive = R"(
base = "vicksburg"
[time]
limit_s = 3.0
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[registration]
method = "none"
[lidar]
azimuth_steps = 600
[[autonomy.waypoint]]
name = "house"
p_m = [213.9, 150.0]
observe = "building 273"
)";

/// Drives straight on for 1.5 s, and never answers again.
class NeverReturns final : public mission::Autonomy {
 public:
  void see(const LidarScan&, const Pose&, const NavEstimate&) override {}
  DriveCommand drive(const NavEstimate&) override {
    while (left_ == 0) std::this_thread::sleep_for(std::chrono::seconds(1));
    --left_;
    return {1.0, 0.0};
  }
  mission::AutonomyState state() const override { return mission::AutonomyState::kDriving; }
  int next_waypoint() const override { return 0; }

 private:
  int left_ = 150;
};

/// As study::compare() drives a run, with an autonomy of one's own.
Result<mission::RunRecord> drive_into(const std::string& directory, const Comparison& comparison, std::size_t i,
                                      std::unique_ptr<mission::Autonomy> autonomy, RunSummary& summary) {
  RunStatistics statistics(comparison.missions[i].scene->frame(), directory);
  CANYON_TRY(const auto files, mission::RunFiles::create(directory, comparison.plan[i].name, comparison.configs[i],
                                                         comparison.missions[i], nullptr));
  mission::Recorders all({&statistics, files.get()});
  CANYON_TRY(auto record, mission::run_mission(comparison.configs[i], comparison.missions[i], nullptr,
                                               {.recorder = &all, .autonomy = std::move(autonomy)}));
  record.name = comparison.plan[i].name;
  record.gnss = comparison.plan[i].gnss;
  record.imu = comparison.plan[i].imu;
  CANYON_TRY(summary, summarize(record, statistics));
  return record;
}

class FaultyRun : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::path(::testing::TempDir()) / "canyon-faulty-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr) << name;
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string read(const std::string& name) const {
    std::ostringstream out;
    out << std::ifstream(folder_ / name).rdbuf();
    return out.str();
  }
  std::filesystem::path folder_;
};

TEST_F(FaultyRun, OneThatNeverReturnsLeavesTheOthersAndAllResultsWhole) {
  const auto file = mission::MissionFile::parse(kFaultyDrive, "drive.toml");
  ASSERT_TRUE(file.ok());
  std::vector<RunPlan> plan;
  for (const char* name : {"seed_1", "seed_2", "seed_3", "seed_4"}) plan.push_back({name, "low", "low", ""});
  auto prepared = prepare_comparison(*file, plan);
  ASSERT_TRUE(prepared.ok()) << prepared.error().str();
  Comparison& comparison = *prepared;
  for (std::size_t i = 0; i < plan.size(); ++i) comparison.configs[i].run.seed = static_cast<std::int64_t>(i + 1);
  constexpr std::size_t kFaulty = 1;
  // Its own alone: a busy machine may well keep a sound one waiting for half a second.
  comparison.configs[kFaulty].autonomy.call_limit_s = 0.5;

  Results results;
  results.mission = &comparison.missions.front();
  results.summaries.resize(plan.size());
  std::vector<std::optional<Result<mission::RunRecord>>> records(plan.size());
  parallel_for(plan.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      records[i] = drive_into(folder_.string(), comparison, i,
                              i == kFaulty ? std::make_unique<NeverReturns>() : nullptr, results.summaries[i]);
  });
  for (auto& record : records) {
    ASSERT_TRUE(record && record->ok()) << (record ? record->error().str() : "");
    results.records.push_back(**std::move(record));
  }
  const auto hash = write_results(folder_.string(), results);
  ASSERT_TRUE(hash.ok()) << hash.error().str();

  const Json runs = Json::parse(read("summary.json"))["runs"];
  ASSERT_EQ(runs.size(), plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    EXPECT_EQ(runs[i]["outcome"], i == kFaulty ? "autonomy_fault" : "stopped") << i;
    const std::string nav = read("epochs/" + plan[i].name + "_nav.csv");
    // A line of names, and ten rows a second up to its end.
    EXPECT_NEAR(static_cast<double>(std::count(nav.begin(), nav.end(), '\n')), i == kFaulty ? 1 + 15 : 1 + 30, 1) << i;
  }
  EXPECT_EQ(runs[kFaulty]["failure"]["detail"], "a call took longer than autonomy.call_limit_s = 0.5 s");
  EXPECT_THAT(comparison_table(results), HasSubstr("seed_2, after 1.5 s at x "));
  EXPECT_THAT(comparison_table(results),
              HasSubstr("m: it was ended by a fault of its autonomy's own (a call took longer "
                        "than autonomy.call_limit_s = 0.5 s)"));
  // The run that stood in the queue behind it is what it is alone.
  const std::filesystem::path apart = folder_ / "alone";
  std::filesystem::create_directories(apart);
  RunSummary alone;
  const auto again = drive_into(apart.string(), comparison, 3, nullptr, alone);
  ASSERT_TRUE(again.ok()) << again.error().str();
  EXPECT_EQ(alone.position_m.rms, results.summaries[3].position_m.rms);
  EXPECT_EQ(alone.distance_m, results.summaries[3].distance_m);
}

}  // namespace
}  // namespace canyon::study
