// canyon fuse on what a run recorded of its filter's input.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/mission/run.h"
#include "canyon/study/compare.h"
#include "canyon/study/fuse/replay.h"
#include "canyon/tests/mission/memory_recorder.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

constexpr const char* kMission = R"(
base = "vicksburg"
[time]
limit_s = 6.0
[registration]
method = "none"
[autonomy]
model = "route_follower"
)";

/// Drives, writes and replays; the estimates at all epochs of the run are those of the run to 1e-9 m, rad and m/s.
void expect_same(const char* filter, const std::string& rates = "[run]\n") {
  const auto file = mission::MissionFile::parse(
      std::string(kMission) + "[fusion]\nfilter = \"" + filter + "\"\n" + rates + "record_filter_input = true\n",
      "my.toml");
  ASSERT_TRUE(file.ok()) << file.error().str();
  const auto comparison = prepare_comparison(*file, plan_runs({"high"}, false));
  ASSERT_TRUE(comparison.ok()) << comparison.error().str();
  const canyon::testing::TemporaryFolder folder;
  const auto results = compare(*comparison, folder.path().string(), false);
  ASSERT_TRUE(results.ok()) << results.error().str();
  ASSERT_TRUE(write_results(folder.path().string(), *results).ok());
  mission::testing::MemoryRecorder run;
  ASSERT_TRUE(mission::run_mission(comparison->configs[0], comparison->missions[0], nullptr,
                                   {.tape = nullptr, .recorder = &run, .autonomy = nullptr})
                  .ok());

  const auto recorded = read_recorded_run(folder.path().string(), "high");
  ASSERT_TRUE(recorded.ok()) << recorded.error().str();
  const auto fused = fuse(recorded->inputs, recorded->plan);
  ASSERT_TRUE(fused.ok()) << fused.error().str();
  ASSERT_EQ(fused->epochs.size(), run.nav.size());
  double most = 0.0;
  for (std::size_t i = 0; i < run.nav.size(); ++i) {
    const NavEstimate &got = fused->epochs[i].estimate, &expected = run.nav[i].estimate;
    EXPECT_EQ(fused->epochs[i].nav.t, run.nav[i].t);
    most = std::max({most, (got.X_WB.p - expected.X_WB.p).norm(), got.X_WB.R.angularDistance(expected.X_WB.R),
                     (got.v_WB_W - expected.v_WB_W).norm()});
  }
  std::printf("replayed %zu epochs: at most %.2g off\n", run.nav.size(), most);
  EXPECT_LT(most, 1e-9);
  EXPECT_EQ(fused->errors.size(), run.nav.size());  // against the run's truth
  EXPECT_EQ(
      read_recorded_run(folder.path().string(), "hihg").error().str(),
      folder.file("manifest.json") + ": --run: unknown name \"hihg\", expected one of \"high\"; nearest is \"high\"");
}

TEST(FuseReplay, TheRunsOwnFilter) {
  expect_same("naive");
}

TEST(FuseReplay, WithTheOdometer) {
  expect_same("vehicle");
}

// Fixes, counts and epochs that fall between samples divide them, as in the run.
TEST(FuseReplay, WhereFixesAndEpochsDivideSamples) {
  expect_same("vehicle",
              "[imu]\nrate_hz = 90.0\n[gnss]\nrate_hz = 3.0\n[odometer]\nrate_hz = 47.0\n[run]\nepoch_rate_hz = 7.0\n");
}

TEST(FuseReplay, ARunWithoutARecordIsRefused) {
  const canyon::testing::TemporaryFolder folder;
  EXPECT_THAT(read_recorded_run(folder.path().string(), "high").error().str(), HasSubstr("manifest.json"));
}

}  // namespace
}  // namespace canyon::study
