#include <filesystem>

#include "canyon/core/files/files.h"
#include "canyon/core/process/parallel.h"
#include "canyon/study/compare.h"
#include "canyon/tests/mission/short_mission.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using mission::testing::drive;
using mission::testing::RecordedRun;
using mission::testing::short_config;

constexpr const char* kShortRun = R"(
base = "vicksburg"
[time]
limit_s = 8.0
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[autonomy]
[[autonomy.waypoint]]
name = "house"
p_m = [213.9, 150.0]
observe = "building 273"
)";

/// Hash of the results directory of a short registered run on `threads` threads, in a scene of its own: what is made
/// of it counts.
std::string hash_with(int threads, const std::string& directory) {
  set_threads(threads);
  const auto file = mission::MissionFile::parse(kShortRun, "short.toml");
  const auto comparison = prepare_comparison(*file, plan_runs({"high"}, false));
  std::filesystem::create_directories(directory);
  const auto results = compare(*comparison, directory, false);
  const auto hash = write_results(directory, *results);
  EXPECT_TRUE(hash.ok()) << (hash.ok() ? "" : hash.error().str());
  const auto& counters = results->summaries.front().counters;
  for (const char* worked :
       {"gnss_path_searches", "gnss_facets_tested", "lidar_rays", "filter_predictions", "registration_correspondences"})
    EXPECT_GT(counters.at(worked), 0) << worked;
  set_threads(0);
  return *hash;
}

TEST(Determinism, ResultsAreTheSameBitsForAnyNumberOfThreads) {
  const std::string base = canyon::testing::temporary_file("threads_");
  const std::string one = hash_with(1, base + "1"), two = hash_with(2, base + "2"), eight = hash_with(8, base + "8");
  EXPECT_EQ(one, two);
  EXPECT_EQ(one, eight);
}

TEST(Determinism, AnotherSeedGivesOtherResults) {
  const RecordedRun a = drive(short_config("high", "high", "[time]\nlimit_s = 2.0"));
  const RecordedRun b = drive(short_config("high", "high", "[time]\nlimit_s = 2.0\n[run]\nseed = 2"));
  EXPECT_NE(a.nav.back().estimate.X_WB.p, b.nav.back().estimate.X_WB.p);
}

}  // namespace
}  // namespace canyon::study
