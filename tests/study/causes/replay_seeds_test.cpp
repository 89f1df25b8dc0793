// Noise seeds of the replays that tell causes.
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/study/causes/causes.h"
#include "canyon/study/seeds/further_seeds.h"

namespace canyon::study {
namespace {

// 2026-11-30: with more than a thousand draws those of one run's seed were the next one's.
TEST(ReplaySeeds, NoTwoAreAlikeAndNoneIsARuns) {
  const std::vector<std::int64_t> runs{0, 1, 2, 999, 1000, 1001, kLargestSeed - 1, kLargestSeed};
  std::set<std::uint64_t> seeds;
  for (const std::int64_t run : runs)
    for (int draw = 0; draw < kMostDraws; ++draw) seeds.insert(replay_seed(run, draw));
  EXPECT_EQ(seeds.size(), runs.size() * kMostDraws);
  EXPECT_GT(*seeds.begin(), static_cast<std::uint64_t>(kLargestSeed));
}

TEST(ReplaySeeds, ThrowOutsideOfTheirRange) {
  EXPECT_THROW(static_cast<void>(replay_seed(1, kMostDraws)), ProgramError);
  EXPECT_THROW(static_cast<void>(replay_seed(1, -1)), ProgramError);
  EXPECT_THROW(static_cast<void>(replay_seed(-1, 0)), ProgramError);
  EXPECT_THROW(static_cast<void>(replay_seed(kLargestSeed + 1, 0)), ProgramError);
}

}  // namespace
}  // namespace canyon::study
