// What takes minutes: plans of several scenes replayed, and closed loops of several seeds with a plan and without.
#include <gtest/gtest.h>

#include "canyon/mission/route_tape.h"
#include "canyon/study/plan/verify.h"
#include "canyon/tests/study/plan/planned.h"

namespace canyon::study {
namespace {

using mission::testing::RecordedRun;
using testing::kDriving;
using testing::Planned;

constexpr const char* kField =
    "[time]\nlimit_s = 60.0\n[scene]\nempty = true\n[[autonomy.waypoint]]\nname = \"1\"\np_m = [213.9, 109.9]\n";
constexpr const char* kCity = "[time]\nlimit_s = 60.0\n";

TEST(PlanNightly, HoldsWhereverItIsReplayed) {
  const struct {
    const char *fidelity, *scene;
    bool open_loop;
    FigureValues tolerances;
  } missions[] = {{"high", kField, false, {}},
                  {"high", kCity, false, {}},
                  {"paper", kCity, false, {}},
                  {"high", kField, true, {{"position_error_rms_m", 0.05}}},
                  {"high", kCity, true, {{"position_error_rms_m", 0.05}}}};
  for (const auto& [fidelity, scene, open_loop, tolerances] : missions) {
    const auto outputs = open_loop ? std::vector<Output>{Output::kPosition} : kDriving;
    const Planned planned(fidelity, scene, outputs, open_loop, tolerances);
    const auto tape = mission::drive_route(planned.config, planned.mission);
    ASSERT_TRUE(tape.ok());
    const auto found = verify_plan(planned.config, planned.mission, *tape, planned.plan, 600);
    ASSERT_TRUE(found.ok());
    for (const VerifiedEffect& effect : found->effects)
      EXPECT_EQ(effect.violations, 0) << fidelity << " " << scene << effect.effect;
    EXPECT_GE(found->epochs(Verified::kReaders), 600);
    if (!tolerances.empty()) {
      EXPECT_EQ(found->epochs(Verified::kRanges), 600);
      EXPECT_GE(found->epochs(Verified::kEstimates), 600);
    }
  }
}

TEST(PlanNightly, AClosedLoopOfAnySeedGoesTheSameWayWhereBoundsAreZero) {
  for (std::int64_t seed = 1; seed <= 50; ++seed) {
    const Planned planned("high", "[time]\nlimit_s = 40.0\n[run]\nseed = " + std::to_string(seed) + "\n", kDriving);
    ASSERT_EQ(planned.config.run.seed, seed);
    const RecordedRun full = planned.drive(false), less = planned.drive(true);
    EXPECT_LT(less.counters.at("lidar_returns"), full.counters.at("lidar_returns")) << seed;
    EXPECT_EQ(less.counters.at("keyframes_registered"), 0) << seed;
    ASSERT_EQ(full.nav.size(), less.nav.size()) << seed;
    for (std::size_t i = 0; i < full.nav.size(); ++i) {
      ASSERT_EQ(full.nav[i].X_WB_true.p, less.nav[i].X_WB_true.p) << seed << " " << i;
      ASSERT_EQ(full.nav[i].estimate.X_WB.p, less.nav[i].estimate.X_WB.p) << seed << " " << i;
      ASSERT_EQ(full.nav[i].estimate.pose_covariance, less.nav[i].estimate.pose_covariance) << seed << " " << i;
    }
  }
}

}  // namespace
}  // namespace canyon::study
