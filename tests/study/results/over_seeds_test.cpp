#include "canyon/study/results/over_seeds.h"

#include <algorithm>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/study/seeds/further_seeds.h"
#include "canyon/study/statistics/proportions.h"

namespace canyon::study {
namespace {

using mission::Outcome;
using ::testing::HasSubstr;

RunSummary run_of(const char* name, std::int64_t seed, Outcome outcome, double error_m) {
  RunSummary run;
  run.name = run.gnss = run.imu = name;
  run.seed = seed;
  run.outcome = outcome;
  run.position_m.rms = error_m;
  return run;
}

/// Seeds 7 to 26: low always succeeds; high with the first three; its error is the seed times one metre, but with seed
/// 10, at which it is undefined.
std::vector<std::vector<RunSummary>> twenty_seeds(bool open_loop) {
  std::vector<std::vector<RunSummary>> seeds;
  for (int seed = 7; seed < 27; ++seed) {
    const Outcome of_high = seed < 10 ? Outcome::kSuccess : seed % 2 == 0 ? Outcome::kStuck : Outcome::kCollision;
    seeds.push_back(
        {run_of("low", seed, Outcome::kSuccess, 0.5), run_of("high", seed, of_high, seed == 10 ? kNaN : seed)});
    for (RunSummary& run : seeds.back()) run.open_loop = open_loop;
  }
  return seeds;
}

const FigureOverSeeds& figure_of(const OverSeeds& found, std::size_t run, std::string_view key) {
  for (const FigureOverSeeds& row : found.figures[run])
    if (row.figure->key == key) return row;
  throw std::out_of_range(std::string(key));
}

TEST(OverSeeds, SharesAndTheirPairedDifference) {
  const OverSeeds found = over_seeds(twenty_seeds(false));
  EXPECT_EQ(found.seeds.front(), 7);
  EXPECT_EQ(found.seeds.size(), 20U);
  ASSERT_EQ(found.shares.size(), 2U);
  EXPECT_EQ(found.shares[1].fidelity, "high");
  EXPECT_EQ(found.shares[1].success, 3);
  EXPECT_EQ(found.shares[1].n, 20);
  EXPECT_EQ(found.shares[1].outcomes, (std::map<std::string, int>{{"collision", 8}, {"stuck", 9}, {"success", 3}}));
  EXPECT_EQ(found.shares[1].interval.low, wilson_interval(3, 20).low);
  ASSERT_EQ(found.paired.size(), 1U);
  EXPECT_EQ(found.paired[0].a, "low");
  EXPECT_EQ(found.paired[0].b, "high");
  EXPECT_EQ(found.paired[0].figure, "success");
  EXPECT_DOUBLE_EQ(found.paired[0].difference, -17.0 / 20.0);
  EXPECT_LT(found.paired[0].interval.low, -0.85);
  EXPECT_GT(found.paired[0].interval.high, -0.85);
  EXPECT_DOUBLE_EQ(found.paired[0].p, 2.0 / 131072.0);  // 17 discordant pairs, all one way
}

TEST(OverSeeds, MediansAreOverTheSeedsAtWhichAFigureIsDefined) {
  const OverSeeds found = over_seeds(twenty_seeds(false));
  const FigureOverSeeds& error = figure_of(found, 1, "position_error_rms_m");
  EXPECT_EQ(error.n, 19);
  EXPECT_EQ(error.median.value, 17.0);  // of 7, 8, 9, 11 ... 26 the tenth
  EXPECT_EQ(error.lowest, 7.0);
  EXPECT_EQ(error.highest, 26.0);
  EXPECT_EQ(error.median.interval.low, 12.0);  // ranks 5 and 15 of 19 (96 %)
  EXPECT_EQ(error.median.interval.high, 22.0);
  EXPECT_EQ(figure_of(found, 1, "gdop_median").n, 0);
}

// In an open loop nobody drives: there is no share, and figures are compared seed by seed.
TEST(OverSeeds, OfAnOpenLoopFiguresArePaired) {
  const OverSeeds found = over_seeds(twenty_seeds(true));
  EXPECT_TRUE(found.shares.empty());
  ASSERT_FALSE(found.paired.empty());
  const auto pair = std::find_if(found.paired.begin(), found.paired.end(),
                                 [](const auto& p) { return p.figure == "position_error_rms_m"; });
  ASSERT_NE(pair, found.paired.end());
  EXPECT_EQ(pair->n, 19);
  EXPECT_DOUBLE_EQ(pair->difference, (7 + 8 + 9 + (11 + 26) * 16 / 2) / 19.0 - 0.5);
  EXPECT_DOUBLE_EQ(pair->p, 2.0 / 524288.0);  // larger 19 times of 19
  EXPECT_LT(pair->interval.low, pair->difference);
}

TEST(OverSeeds, JsonHasTheContractsKeys) {
  nlohmann::ordered_json json;
  write_over_seeds(over_seeds(twenty_seeds(false)), json);
  EXPECT_EQ(json["seeds"].size(), 20U);
  for (const char* key : {"fidelity", "success", "n", "low", "high"})
    EXPECT_TRUE(json["shares"][0].contains(key)) << key;
  for (const char* key : {"a", "b", "difference", "low", "high", "p"})
    EXPECT_TRUE(json["paired"][0].contains(key)) << key;
  EXPECT_EQ(json["over_seeds"][1]["figures"]["position_error_rms_m"]["median"], 17.0);
  EXPECT_TRUE(json["over_seeds"][1]["figures"]["gdop_median"]["median"].is_null());
  EXPECT_TRUE(json["over_seeds"][1]["timing"].contains("cpu_s"));
  EXPECT_FALSE(json["over_seeds"][1]["figures"].contains("cpu_s"));
  write_over_seeds(over_seeds(twenty_seeds(true)), json);
  EXPECT_TRUE(json["shares"].is_null());
}

TEST(OverSeeds, TheTableHasMediansSharesAndDifferences) {
  const std::string table = over_seeds_table(over_seeds(twenty_seeds(false)), {"position_error_rms_m"});
  EXPECT_THAT(table, HasSubstr("median over 20 seeds, 7 to 26, with its 95 % interval\n"));
  EXPECT_THAT(table, ::testing::ContainsRegex(
                         "position error, RMS, m +0.500 \\[0.500, 0.500\\] +17.000 \\[12.000, 22.000\\] +34.0\n"));
  EXPECT_THAT(table, ::testing::ContainsRegex("high +3 of 20 +0.05 to 0.36 +collision 8, stuck 9, success 3\n"));
  EXPECT_THAT(table, ::testing::ContainsRegex("high - low, success +-0.85 +-0.9[0-9] to -0.[0-9]+ +1.5e-05\n"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("nan")));
  const std::string open = over_seeds_table(over_seeds(twenty_seeds(true)), {"position_error_rms_m"});
  EXPECT_THAT(open, HasSubstr("high - low, position error, RMS"));
  EXPECT_THAT(open, ::testing::Not(HasSubstr("success")));
}

// 2026-11-30: some thirty rows of "-" stood in an open loop's table, and its 2 x 2 in summary.json alone.
TEST(OverSeeds, ATableOfAllFiguresHasNoRowThatNoRunHas) {
  const std::string table = over_seeds_table(over_seeds(twenty_seeds(true)));
  EXPECT_THAT(table, HasSubstr("position error, RMS, m"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("GDOP")));
  const std::string asked = over_seeds_table(over_seeds(twenty_seeds(true)), {"gdop_median"});
  EXPECT_THAT(asked, HasSubstr("GDOP")) << "who asks for it sees that there is none";
}

TEST(OverSeeds, TheTwoByTwoIsOfMedians) {
  std::vector<std::vector<RunSummary>> seeds = twenty_seeds(true);
  EXPECT_EQ(squares_over_seeds(over_seeds(seeds), seeds.front()), "") << "without the mixed runs";
  for (const bool open_loop : {true, false}) {
    seeds = twenty_seeds(open_loop);
    for (std::vector<RunSummary>& runs : seeds) {
      for (const bool gnss : {true, false}) {
        RunSummary mixed = run_of(gnss ? "a" : "b", runs[0].seed, Outcome::kSuccess, gnss ? 6.0 : 1.0);
        mixed.gnss = gnss ? "high" : "low";
        mixed.imu = gnss ? "low" : "high";
        mixed.open_loop = open_loop;
        runs.push_back(mixed);
      }
    }
    const std::string square = squares_over_seeds(over_seeds(seeds), seeds.front());
    const std::string of = open_loop ? "" : "successes and ", all = open_loop ? "" : "20 of 20  ",
                      three = open_loop ? "" : "3 of 20  ";
    EXPECT_THAT(square, HasSubstr("2 x 2, " + std::string(open_loop ? "open" : "closed") + " loop: " + of +
                                  "position error RMS, m, median over 20 seeds\n"));
    const auto row = [](const std::string& text) { return ::testing::ContainsRegex(text); };
    EXPECT_THAT(square, row("low GNSS +" + all + "0.500 .0.500, 0.500. +" + all + "1.000 .1.000, 1.000.\n"));
    EXPECT_THAT(square, row("high GNSS +" + all + "6.000 .6.000, 6.000. +" + three + "17.000 .12.000, 22.000.\n"));
  }
}

constexpr const char* kSeedsMission = R"(
base = "vicksburg"
[time]
limit_s = 2.0
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[registration]
method = "none"
[autonomy]
[[autonomy.waypoint]]
name = "house"
p_m = [213.9, 150.0]
)";

Comparison comparison_of_seed(std::int64_t seed) {
  auto file = mission::MissionFile::parse(kSeedsMission, "my.toml");
  file->set_option("run.seed", ConfigNode::of(seed), "--seed");
  return *prepare_comparison(*file, plan_runs({"low", "high"}, false));
}

nlohmann::ordered_json without_timing(const RunSummary& run) {
  auto json = run_json(run);
  json.erase("timing");
  json.erase("evidence");  // of further seeds the words alone are kept
  return json;
}

// A further seed gives what a comparison of that seed gives, for any number of threads.
TEST(FurtherSeeds, AreTheRunsOfThoseSeeds) {
  const Comparison comparison = comparison_of_seed(5);
  const Results alone = *compare(comparison_of_seed(7), "", false);
  for (const int threads : {1, 2, 8}) {
    set_threads(threads);
    Results results = *compare(comparison, "", false);
    ASSERT_TRUE(add_further_seeds(comparison, 2, "", false, results).ok());
    const auto seeds = runs_by_seed(results);
    ASSERT_EQ(seeds.size(), 3U);
    EXPECT_EQ(seeds[1][0].seed, 6);
    EXPECT_EQ(results.records.size(), 2U) << "rows are those of the first seed";
    for (std::size_t run = 0; run < 2; ++run)
      EXPECT_EQ(without_timing(seeds[2][run]), without_timing(alone.summaries[run])) << threads << " threads";
    EXPECT_EQ(summary_json(results)["runs"].size(), 6U);
  }
  set_threads(0);
}

TEST(FurtherSeeds, SeedsBeyondTheLargestAreRefused) {
  const Comparison comparison = comparison_of_seed(8'999'999'999'999'999);
  EXPECT_TRUE(check_seeds(comparison, 2).ok());
  const Status refused = check_seeds(comparison, 3);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().str(), "--seeds: 3 seeds from 8999999999999999 on, expected none beyond 9000000000000000");
}

TEST(FurtherSeeds, StopAtOnceWhenAsked) {
  const Comparison comparison = comparison_of_seed(5);
  Results results;
  set_cancel_requested(true);
  EXPECT_THROW((void)add_further_seeds(comparison, 2, "", false, results), Cancelled);
  set_cancel_requested(false);
}

}  // namespace
}  // namespace canyon::study
