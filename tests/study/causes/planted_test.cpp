// Failures whose cause was put there: what --why names is held against it.
#include <algorithm>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/tests/study/causes/planted_failures.h"
#include "canyon/tests/support/setting.h"

namespace canyon::study::testing {
namespace {

constexpr int kDraws = 12;

/// CANYON_PLANTS_SEED draws other failures, from 101 on such that nothing was looked at with while plants were made.
std::int64_t first_planted_seed() {
  return std::stoll(canyon::testing::setting("CANYON_PLANTS_SEED", "1"));
}
/// CANYON_PLANTS_EACH: so many failures of each plant.
int failures_of_each(const char* otherwise) {
  return std::stoi(canyon::testing::setting("CANYON_PLANTS_EACH", otherwise));
}

/// What is named of its one run's failure; none: it succeeded.
std::optional<Explanation> named(const Plant& plant, const Comparison& comparison) {
  const auto results = compare(comparison, "", false);
  EXPECT_TRUE(results.ok()) << plant.name << ": " << (results.ok() ? "" : results.error().str());
  if (!results.ok() || !results->records.front().failure) return std::nullopt;
  auto why = explain_failures(comparison, *results, kDraws, false);
  EXPECT_TRUE(why.ok()) << plant.name << ": " << (why.ok() ? "" : why.error().str());
  if (!why.ok()) return std::nullopt;
  return why->front();
}

/// The same of a planted failure; none: this seed's drive succeeded in spite of it.
std::optional<Explanation> named(const Plant& plant, std::int64_t seed) {
  const auto comparison = planted(plant, seed);
  EXPECT_TRUE(comparison.ok()) << plant.name << ": " << (comparison.ok() ? "" : comparison.error().str());
  if (!comparison.ok()) return std::nullopt;
  return named(plant, *comparison);
}

bool is_right(const Plant& plant, const Explanation& e) {
  if (e.cause == nullptr) return plant.causes.empty();
  return std::find(plant.causes.begin(), plant.causes.end(), e.cause->name) != plant.causes.end();
}

std::string told(const Plant& plant, std::int64_t seed, const Explanation& e) {
  std::string line = std::string(is_right(plant, e) ? "right" : "WRONG") + " | " + plant.name + " | seed " +
                     std::to_string(seed) + " | " + name(e.failure.kind) + " after " + std::to_string(e.failure.t_s) +
                     " s, from " + std::to_string(e.from_s) + " s | " + (e.cause == nullptr ? "none" : e.cause->name) +
                     " | as it was " + std::to_string(e.successes_as_it_was);
  for (const RemovalOutcome& o : e.outcomes)
    line += std::string(" ") + o.removal->name + " " + std::to_string(o.successes);
  return line;
}

/// One look at removals of which none does anything: whether any is named, by the toss of a coin for every replay.
bool names_something(const RandomStream& coin, std::uint64_t& draw, double share) {
  constexpr int kRemovals = 8;
  const auto toss = [&] { return coin.uniform(0.0, 1.0, 0, draw++) < share; };
  std::vector<bool> as_it_was;
  for (int i = 0; i < kDraws; ++i) as_it_was.push_back(toss());
  std::vector<double> p;
  for (int r = 0; r < kRemovals; ++r) {
    int rescued = 0, harmed = 0;
    for (const bool before : as_it_was) {
      const bool without = toss();
      rescued += without && !before ? 1 : 0;
      harmed += !without && before ? 1 : 0;
    }
    p.push_back(fair_coin_tail(harmed, harmed + rescued));
  }
  const std::vector<bool> significant = holm(p, 0.05 / 2);
  return std::find(significant.begin(), significant.end(), true) != significant.end();
}

// Two looks at 2.5 % each, whatever the share of success: of 4000 experiments at 5 % one in 40 has more than 5.7 %.
// So much of the test and of Holm's rule, without the interval, which can only make it rarer; a toss of its own for
// every replay. That replays of one drive share most draws, and that only what failed is looked at, is not in it:
// PlantedByChanceNightly is about drives.
TEST(PlantedCauses, WhereNothingHelpsNothingIsNamed) {
  const RandomStream coin(1, "tests.planted_causes");
  std::uint64_t draw = 0;
  constexpr int kExperiments = 4000;
  for (const double share : {0.1, 0.3, 0.5, 0.8}) {
    int named = 0;
    for (int k = 0; k < kExperiments; ++k) {
      const bool first = names_something(coin, draw, share), second = names_something(coin, draw, share);
      named += first || second ? 1 : 0;
    }
    EXPECT_LE(named, 0.057 * kExperiments) << share;
  }
}

TEST(PlantedCauses, ACheapUnitWithoutFixesIsNamed) {
  for (std::int64_t seed = 1; seed <= 4; ++seed) {
    const Plant& plant = plants().front();
    const auto e = named(plant, seed);
    if (!e) continue;
    EXPECT_TRUE(is_right(plant, *e)) << told(plant, seed, *e);
    // It drifts metres while it drives ten, so that what it passes stands twice in its map.
    EXPECT_TRUE(std::any_of(e->events.begin(), e->events.end(), [](const Event& event) {
      return event.kind == EventKind::kMapDoubled;
    })) << told(plant, seed, *e);
    // What acts at the start alone is taken away in replays from the start alone.
    const auto from_start = std::count_if(e->outcomes.begin(), e->outcomes.end(),
                                          [](const RemovalOutcome& o) { return o.removal->make.from_start; });
    EXPECT_EQ(from_start, e->from_s > 0.0 ? 0 : 1) << told(plant, seed, *e);
    return;
  }
  FAIL() << "no seed fails";
}

// Asked for: of 30 failures and more the planted cause is named in 90 %, and where there is none, one in 5 %.
TEST(PlantedCausesNightly, TheFirstNamedIsThePlantedOne) {
  const int each = failures_of_each("3");
  const std::int64_t first = first_planted_seed(), last = first + 3 * each - 1;
  std::map<Plant::Kind, std::pair<int, int>> right;  // of all
  for (const Plant& plant : plants()) {
    int failures = 0;
    for (std::int64_t seed = first; seed <= last && failures < each; ++seed) {
      const auto e = named(plant, seed);
      if (!e) continue;
      ++failures;
      auto& [good, all] = right[plant.kind];
      good += is_right(plant, *e) ? 1 : 0;
      ++all;
      std::printf("%s\n", told(plant, seed, *e).c_str());
      std::fflush(stdout);
    }
    EXPECT_GT(failures, 0) << plant.name;
  }
  int good = 0, all = 0;
  for (const auto& [kind, counts] : right) {
    if (kind == Plant::Kind::kNone) {
      EXPECT_GE(counts.first, 0.95 * counts.second);
      continue;
    }
    good += counts.first;
    all += counts.second;
  }
  EXPECT_GE(all, 30);
  EXPECT_GE(good, 0.9 * all);
}

/// One plant each, by its number.
class PlantedByChanceNightly : public ::testing::TestWithParam<std::size_t> {};

// One in 20 is asked for: one of 30. Twelve draws come in large steps: over eight removals nothing is named that
// rescues fewer than nine of them, or harms one, and tosses of a coin bring that about in 0.2 % of failures at most. Of
// these two in 30 would be a chance of 0.2 %. A removal that changes no outcome cannot be named: each must change some.
TEST_P(PlantedByChanceNightly, NoCauseIsNamed) {
  const Plant& plant = plants_of_chance().at(GetParam());
  const int each = failures_of_each("30");
  const std::int64_t first = first_planted_seed();
  auto comparison = planted(plant, first);  // one city for all seeds, which takes longer to make than a drive
  ASSERT_TRUE(comparison.ok()) << comparison.error().str();
  int failures = 0, mistaken = 0, home = 0, with_truth = 0;
  std::vector<int> moved(removals().size());  // by removal, pairs of which one alone succeeds
  for (std::int64_t seed = first; seed < first + 6 * each && failures < each; ++seed) {
    comparison->configs.front().run.seed = seed;
    const auto e = named(plant, *comparison);
    if (!e) continue;
    ++failures;
    mistaken += is_right(plant, *e) ? 0 : 1;
    home += e->successes_as_it_was;
    with_truth += e->outcomes.back().successes;        // the widest is the last row
    for (const RemovalOutcome& outcome : e->outcomes)  // not all are asked about in every look
      moved[static_cast<std::size_t>(outcome.removal - removals().data())] +=
          outcome.pairs.only_a + outcome.pairs.only_b;
    std::printf("%s\n", told(plant, seed, *e).c_str());
    std::fflush(stdout);
  }
  std::printf(
      "%s: of %d failures a cause is named in %d (at most %.3f); as it was %d of %d redraws succeed, with the "
      "true pose %d; pairs that differ:",
      plant.name, failures, mistaken, wilson_interval(mistaken, failures).high, home, kDraws * failures, with_truth);
  for (std::size_t r = 0; r < moved.size(); ++r) std::printf(" %s %d", removals()[r].name, moved[r]);
  std::printf("\n");
  EXPECT_EQ(failures, each);
  // It hangs on the draws, or nothing could be mistaken; and navigation is not to blame.
  EXPECT_GT(home, 0.1 * kDraws * failures);
  EXPECT_LT(home, 0.9 * kDraws * failures);
  EXPECT_LT(with_truth, home);
  for (std::size_t r = 0; r < moved.size(); ++r) EXPECT_GT(moved[r], 0) << removals()[r].name << " changes nothing";
  EXPECT_LE(mistaken, 0.05 * failures);
}

INSTANTIATE_TEST_SUITE_P(Plants, PlantedByChanceNightly, ::testing::Range(std::size_t{0}, plants_of_chance().size()));

}  // namespace
}  // namespace canyon::study::testing
