// Failures whose cause was put there: what --why names is held against it.
#include <algorithm>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/tests/study/causes/planted_failures.h"

namespace canyon::study::testing {
namespace {

constexpr int kDraws = 12;

/// What is named of a planted failure; none: this seed's drive succeeded in spite of it.
std::optional<Explanation> named(const Plant& plant, std::int64_t seed) {
  const auto comparison = planted(plant, seed);
  EXPECT_TRUE(comparison.ok()) << plant.name << ": " << (comparison.ok() ? "" : comparison.error().str());
  if (!comparison.ok()) return std::nullopt;
  const auto results = compare(*comparison, "", false);
  EXPECT_TRUE(results.ok()) << plant.name << ": " << (results.ok() ? "" : results.error().str());
  if (!results.ok() || !results->records.front().failure) return std::nullopt;
  auto why = explain_failures(*comparison, *results, kDraws, false);
  EXPECT_TRUE(why.ok()) << plant.name << ": " << (why.ok() ? "" : why.error().str());
  if (!why.ok()) return std::nullopt;
  return why->front();
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
    return;
  }
  FAIL() << "no seed fails";
}

// Asked for: of 30 failures and more the planted cause is named in 90 %, and where there is none, one in 5 %.
TEST(PlantedCausesNightly, TheFirstNamedIsThePlantedOne) {
  constexpr int kEach = 3;
  constexpr std::int64_t kSeeds = 8;
  std::map<Plant::Kind, std::pair<int, int>> right;  // of all
  for (const Plant& plant : plants()) {
    int failures = 0;
    for (std::int64_t seed = 1; seed <= kSeeds && failures < kEach; ++seed) {
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

}  // namespace
}  // namespace canyon::study::testing
