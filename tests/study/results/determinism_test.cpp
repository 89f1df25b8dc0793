#include <filesystem>

#include "canyon/core/files/files.h"
#include "canyon/core/process/parallel.h"
#include "canyon/study/results/results.h"
#include "canyon/tests/mission/short_mission.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using mission::MissionConfig;
using mission::RunRecord;
using mission::testing::drive;
using mission::testing::scenes;
using mission::testing::short_config;

/// Hash of the results directory of a short registered run on `threads` threads.
std::string hash_with(int threads, const std::string& directory) {
  set_threads(threads);
  const MissionConfig config = short_config("high", "high", "[time]\nlimit_s = 8.0\n[registration]\nmethod = \"gicp\"");
  const auto mission = prepare(config, scenes());
  Results results;
  results.mission = &*mission;
  results.records.push_back(drive(config));
  results.records.back().name = results.records.back().gnss = results.records.back().imu = "high";
  results.summaries.push_back(summarize(results.records.back()));
  std::filesystem::create_directories(directory);
  const auto hash = write_results(directory, results);
  EXPECT_TRUE(hash.ok()) << (hash.ok() ? "" : hash.error().str());
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
  const RunRecord a = drive(short_config("high", "high", "[time]\nlimit_s = 2.0"));
  const RunRecord b = drive(short_config("high", "high", "[time]\nlimit_s = 2.0\n[run]\nseed = 2"));
  EXPECT_NE(a.nav.back().estimate.X_WB.p, b.nav.back().estimate.X_WB.p);
}

}  // namespace
}  // namespace canyon::study
