// What a run gathers for the verdict on its filter.
#include "canyon/fusion/verdict/run_evidence.h"

#include <gtest/gtest.h>

#include "canyon/tests/fusion/matched_world.h"

namespace canyon::fusion {
namespace {

using testing::matched_keys;
using testing::matched_unit;
using testing::MatchedWorld;

// Whoever looks changes nothing: state and covariance are those of a filter that nobody looks at, to the last bit.
TEST(RunEvidence, ChangesNothingOfTheFilter) {
  MatchedWorld world(3), same(3);
  ErrorStateFilter watched = world.filter(matched_keys(), matched_unit()),
                   alone = same.filter(matched_keys(), matched_unit());
  RunEvidence evidence;
  evidence.follow(watched);
  world.told = [&](const UpdateReport& report) { evidence.innovation(report); };
  for (int k = 0; k < 1000; ++k) {
    world.step(watched);
    same.step(alone);
    evidence.look(watched);
  }
  EXPECT_EQ(watched.nav_state().p_EU_E, alone.nav_state().p_EU_E);
  EXPECT_EQ(watched.nav_state().R_EU.coeffs(), alone.nav_state().R_EU.coeffs());
  EXPECT_EQ(watched.covariance(), alone.covariance());
  const VerdictNumbers numbers = evidence.numbers();
  EXPECT_EQ(numbers.measurements.size(), 6U);
  EXPECT_EQ(numbers.states.size(), static_cast<std::size_t>(watched.state().size()));
  EXPECT_TRUE(numbers.axes.empty());  // nobody told the truth
  EXPECT_FALSE(numbers.fixes.has_value());
}

// States are looked at once a second, however often it is asked.
TEST(RunEvidence, LooksOnceASecond) {
  MatchedWorld world(3);
  ErrorStateFilter filter = world.filter(matched_keys(), matched_unit());
  RunEvidence evidence;
  evidence.follow(filter);
  for (int k = 0; k < 2000; ++k) {
    world.step(filter);
    evidence.look(filter);
  }
  double most = 0.0;
  for (const ProcessNumbers& process : evidence.numbers().processes) most = std::max(most, process.ratio.samples);
  // 20 s at once a second, of at most the states of one process.
  EXPECT_GT(most, 0.0);
  EXPECT_LE(most, 20.0 * 9.0);
}

// Up to 50 instants, evenly spread from the first look on; the last one is that of the share that is told by itself
// where the number of looks comes out so.
TEST(RunEvidence, KeepsWhatIsObservedOverTime) {
  for (const int seconds : {10, 49, 50, 230}) {
    MatchedWorld world(4);
    ErrorStateFilter filter = world.filter(matched_keys(), matched_unit());
    RunEvidence evidence;
    evidence.follow(filter);
    evidence.look(filter);
    for (int k = 0; k < 100 * seconds; ++k) {
      world.step(filter);
      evidence.look(filter);
    }
    const VerdictNumbers numbers = evidence.numbers();
    const std::vector<double>& t_s = numbers.looked_s;
    ASSERT_LE(t_s.size(), 50U);
    ASSERT_GE(t_s.size(), std::min<std::size_t>(static_cast<std::size_t>(seconds) + 1, 25));
    EXPECT_EQ(t_s.front(), 0.0);
    const double apart_s = t_s[1] - t_s[0];
    for (std::size_t i = 1; i < t_s.size(); ++i) EXPECT_NEAR(t_s[i] - t_s[i - 1], apart_s, 1e-6);
    EXPECT_LT(seconds - t_s.back(), apart_s + 1e-6);
    for (const StateNumbers& state : numbers.states) {
      ASSERT_EQ(state.shares.size(), t_s.size()) << state.name;
      EXPECT_EQ(state.shares.front(), 1.0) << state.name;  // nothing has been measured yet
      if (t_s.back() > seconds - 0.5) {
        EXPECT_EQ(state.shares.back(), state.share) << state.name;
      }
      for (const double share : state.shares) EXPECT_TRUE(share >= state.least_share && share <= 1.0) << state.name;
    }
  }
}

}  // namespace
}  // namespace canyon::fusion
