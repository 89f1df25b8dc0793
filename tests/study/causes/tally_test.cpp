// Which failures of several seeds are explained, and how their verdicts are counted: on results laid out by hand.
#include "canyon/study/causes/tally.h"

#include <cstdint>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/study/causes/failed_runs.h"

namespace canyon::study {
namespace {

using mission::Outcome;
using ::testing::HasSubstr;

/// The runs a and b of one seed.
std::vector<RunSummary> ended_runs(std::int64_t seed, Outcome a, Outcome b) {
  std::vector<RunSummary> runs(2);
  for (std::size_t run = 0; run < 2; ++run) {
    const Outcome outcome = run == 0 ? a : b;
    runs[run].name = run == 0 ? "a" : "b";
    runs[run].seed = seed;
    runs[run].outcome = outcome;
    if (outcome == Outcome::kSuccess) continue;
    runs[run].failure = mission::Failure{.kind = outcome,
                                         .t_s = static_cast<double>(seed),
                                         .p_W = Eigen::Vector3d::Zero(),
                                         .detail = "",
                                         .seen = std::nullopt};
  }
  return runs;
}

/// a fails with seeds 7, 9 and 10, b with 8 and 10: with 7 it was stopped, which is no failure.
Results four_seeds_of_two() {
  Results results;
  results.summaries = ended_runs(7, Outcome::kCollision, Outcome::kStopped);
  results.further_seeds = {ended_runs(8, Outcome::kSuccess, Outcome::kTimeout),
                           ended_runs(9, Outcome::kStuck, Outcome::kSuccess),
                           ended_runs(10, Outcome::kCollision, Outcome::kCollision)};
  return results;
}

using RunsAndSeeds = std::vector<std::pair<std::size_t, std::int64_t>>;

RunsAndSeeds runs_and_seeds(const std::vector<FailedRun>& failed) {
  RunsAndSeeds out;
  for (const FailedRun& run : failed) {
    out.emplace_back(run.run, run.seed);
    EXPECT_EQ(run.failure.t_s, static_cast<double>(run.seed)) << "another seed's failure";
  }
  return out;
}

TEST(FailedRuns, AreThoseThatFailedByThemselvesAndTheFirstOnesBySeed) {
  const Results results = four_seeds_of_two();
  EXPECT_EQ(runs_and_seeds(failed_runs(results)), (RunsAndSeeds{{0, 7}, {1, 8}, {0, 9}, {0, 10}, {1, 10}}));
  EXPECT_EQ(runs_and_seeds(failed_runs(results, 2)), (RunsAndSeeds{{0, 7}, {1, 8}, {0, 9}, {1, 10}}));
  EXPECT_EQ(runs_and_seeds(failed_runs(results, 1)), (RunsAndSeeds{{0, 7}, {1, 8}}));
}

/// What replays found: of `cause` it was, or if there is none, with the true pose so many of twelve succeeded.
Explanation explanation_of(const char* run, const char* cause, int with_true_pose) {
  Explanation e;
  e.run = run;
  e.draws = 12;
  for (const auto& row : removals()) {
    RemovalOutcome& outcome = e.outcomes.emplace_back();
    outcome.removal = &row;
    if (row.make.breadth == Breadth::kNavigation) outcome.successes = with_true_pose;
  }
  if (cause != nullptr) e.cause = find_model(removals(), cause);
  return e;
}

void expect_verdict_count(const VerdictCount& count, const char* verdict, int n, double low, double high) {
  EXPECT_EQ(count.verdict, verdict);
  EXPECT_EQ(count.n, n) << verdict;
  // Four digits of Wilson's formula, worked out beside.
  EXPECT_NEAR(count.interval.low, low, 5e-5) << verdict;
  EXPECT_NEAR(count.interval.high, high, 5e-5) << verdict;
}

TEST(CauseTally, CountsTheVerdictsOfEachRun) {
  const std::vector<CauseTally> tally =
      cause_tally(four_seeds_of_two(), {explanation_of("a", "height", 12), explanation_of("b", nullptr, 3),
                                        explanation_of("a", nullptr, 0), explanation_of("a", "height", 11)});
  ASSERT_EQ(tally.size(), 2U);
  EXPECT_EQ(tally[0].run, "a");
  EXPECT_EQ(tally[0].failed, 3);
  EXPECT_EQ(tally[0].explained, 3);
  ASSERT_EQ(tally[0].counts.size(), 3U) << "of causes those that were named";
  expect_verdict_count(tally[0].counts[0], "height", 2, 0.2077, 0.9385);
  expect_verdict_count(tally[0].counts[1], "not_navigation", 1, 0.0615, 0.7923);
  expect_verdict_count(tally[0].counts[2], "undetermined", 0, 0.0, 0.5615);
  EXPECT_EQ(tally[1].run, "b");
  EXPECT_EQ(tally[1].failed, 2);
  EXPECT_EQ(tally[1].explained, 1);
  ASSERT_EQ(tally[1].counts.size(), 2U);
  expect_verdict_count(tally[1].counts[0], "not_navigation", 0, 0.0, 0.7935);
  expect_verdict_count(tally[1].counts[1], "undetermined", 1, 0.2065, 1.0);

  const std::string table = cause_tally_table(tally);
  EXPECT_THAT(table, HasSubstr("a: 3 of 3 failures explained, what they come from (Wilson)\n"
                               "  because of the error of the height    2 of 3   0.21 to 0.94\n"
                               "  navigation is not to blame            1 of 3   0.06 to 0.79\n"
                               "    told its true position each succeeds in 0 of 12 repeats, so in at most 24 % of "
                               "such drives (95 %)\n"
                               "  undetermined                          0 of 3   0.00 to 0.56\n"
                               "b: 1 of 2 failures explained, what they come from (Wilson)\n"
                               "  navigation is not to blame            0 of 1   0.00 to 0.79\n"
                               "  undetermined                          1 of 1   0.21 to 1.00\n"));
  const nlohmann::ordered_json json = cause_tally_json(tally);
  EXPECT_EQ(json[1]["failed"], 2);
  EXPECT_EQ(json[1]["explained"], 1);
  EXPECT_EQ(json[0]["verdicts"][0]["words"], "because of the error of the height");
  EXPECT_EQ(json[0]["verdicts"][1]["note"],
            "told its true position each succeeds in 0 of 12 repeats, so in at most 24 % of such drives (95 %)");
  EXPECT_FALSE(json[1]["verdicts"][0].contains("note")) << "nobody came to it";
}

TEST(CauseTally, WhoNeverFailsHasNone) {
  Results results;
  results.summaries = ended_runs(1, Outcome::kSuccess, Outcome::kStopped);
  EXPECT_TRUE(cause_tally(results, {}).empty());
  EXPECT_EQ(cause_tally_table({}), "");
}

// Of 0 successes in n the upper end is z^2 / (n + z^2), z^2 = 3.8415.
TEST(ReplaysBound, IsWilsonsUpperEnd) {
  EXPECT_EQ(replays_bound(12), "0 of 12 repeats, so in at most 24 % of such drives (95 %)");
  EXPECT_EQ(replays_bound(10), "0 of 10 repeats, so in at most 28 % of such drives (95 %)");
  EXPECT_EQ(replays_bound(100), "0 of 100 repeats, so in at most 3.7 % of such drives (95 %)");
  EXPECT_EQ(replays_bound(10000), "0 of 10000 repeats, so in at most 0.038 % of such drives (95 %)");
}

// Without a rescue it hangs on the replays with the true pose, whatever else succeeds now and then.
TEST(VerdictKindOf, AnExplanation) {
  EXPECT_EQ(verdict_kind(explanation_of("a", "imu", 0)), VerdictKind::kCause);
  EXPECT_EQ(verdict_kind(explanation_of("a", nullptr, 1)), VerdictKind::kUndetermined);
  Explanation others_succeed = explanation_of("a", nullptr, 0);
  others_succeed.outcomes.front().successes = 5;
  EXPECT_EQ(verdict_kind(others_succeed), VerdictKind::kNotNavigation);
  EXPECT_THAT(verdict(others_succeed), HasSubstr("navigation is not to blame. Told its true position it succeeds in 0 "
                                                 "of 12 repeats, so in at most 24 % of such drives (95 %); with "));
}

}  // namespace
}  // namespace canyon::study
