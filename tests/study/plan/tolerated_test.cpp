// What acts by less than a tolerance: bounds, what is chosen within them, and that runs keep to them.
#include "canyon/study/plan/tolerated.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/study/plan/replay/replay.h"
#include "canyon/study/plan/replay/run_pair.h"
#include "canyon/study/plan/verify.h"
#include "canyon/tests/study/plan/planned.h"

namespace canyon::study {
namespace {

using testing::kDriving;
using testing::Planned;

constexpr const char* kRms = "position_error_rms_m";
constexpr const char* kShort =
    "[time]\nlimit_s = 8.0\n[scene]\nempty = true\n[[autonomy.waypoint]]\nname = \"1\"\np_m = [213.9, 109.9]\n";

/// A chain that passes what moves the ranges on, twice as large.
PositionChain doubling() {
  return {.most_gain = 3.0, .fix_t_s = {0.0, 1.0}, .fix = {1.0, 1.0}, .any = {2.0, 2.0}, .up = {1.0, 1.0}};
}

PlannedEffect candidate(const char* effect, double bound_m, double saved_s) {
  return {.need = {.effect = effect, .verdict = Verdict::kNotNeeded, .bound = bound_m, .bound_unit = "m"},
          .segment = "whole run",
          .saved_cpu_s = saved_s};
}

TEST(Tolerated, AHalvedBoundFlipsTheVerdict) {
  const RandomStream stream(5, "test.bounds");
  for (std::uint64_t k = 0; k < 20; ++k) {
    const double bound_m = std::pow(10.0, stream.uniform(-5.0, 0.0, 0, k));
    Plan kept, left_out;
    kept.tolerances = left_out.tolerances = {{kRms, 2.0 * bound_m * stream.uniform(0.51, 0.99, 1, k)}};
    std::vector<PlannedEffect> right{candidate(gnss::kEphemeris, bound_m, 1.0)};
    std::vector<PlannedEffect> halved{candidate(gnss::kEphemeris, 0.5 * bound_m, 1.0)};
    choose_within_tolerances(doubling(), right, kept);
    choose_within_tolerances(doubling(), halved, left_out);
    EXPECT_EQ(right[0].need.verdict, Verdict::kNeeded) << k;
    EXPECT_FALSE(kept.omissions.ranges.any()) << k;
    EXPECT_EQ(halved[0].need.verdict, Verdict::kNotNeeded) << k;
    EXPECT_TRUE(left_out.omissions.ranges.delays.ephemeris) << k;
  }
}

TEST(Tolerated, TheLargestSavingPerBoundComesFirstAndBoundsAddUp) {
  Plan plan;
  plan.tolerances = {{kRms, 0.05}};
  std::vector<PlannedEffect> candidates{candidate(gnss::kIonosphereDifference, 0.02, 1.0),
                                        candidate(gnss::kEphemeris, 0.01, 2.0),
                                        candidate(gnss::kTroposphereDifference, 0.01, 1.5)};
  choose_within_tolerances(doubling(), candidates, plan);
  EXPECT_TRUE(plan.omissions.ranges.delays.ephemeris);
  EXPECT_TRUE(plan.omissions.ranges.delays.troposphere_difference);
  EXPECT_FALSE(plan.omissions.ranges.delays.ionosphere_difference) << "0.04 + 0.04 is more than 0.05";
  EXPECT_DOUBLE_EQ(plan.figure_bounds.at(kRms), 0.04);
  EXPECT_DOUBLE_EQ(plan.omissions.ranges.bound_m, 0.02);
  EXPECT_EQ(plan.omissions.ranges.most_gain, 3.0);
}

TEST(Tolerated, AFigureThatNoBoundReachesIsNamed) {
  const auto status = check_reached({{"gdop_max", 1.0}}, "--tolerance");
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().str(),
              ::testing::StartsWith("--tolerance: gdop_max: no bound reaches this figure, so nothing could be left out "
                                    "for it, expected one of position_error_rms_m, "));
  EXPECT_EQ(status.error().exit_code, 2);
}

TEST(Tolerated, WithoutAToleranceNothingThatActsIsLeftOut) {
  const Planned planned("high", kShort, kDriving);
  EXPECT_FALSE(planned.plan.omissions.ranges.any());
  for (const PlannedEffect& line : planned.plan.effects) {
    const bool left_out = line.need.verdict == Verdict::kNotNeeded;
    EXPECT_TRUE(!left_out || line.need.bound == 0.0) << line.need.effect;
  }
  EXPECT_EQ(planned.verdict(gnss::kIonosphere), Verdict::kNeeded);
}

// The paper's differential mode removes ionosphere and ephemeris error whole: not a bit differs.
TEST(Tolerated, WhatAModeRemovesWholeIsLeftOutToTheBit) {
  const Planned planned("paper", kShort, {Output::kPosition}, true);
  EXPECT_TRUE(planned.plan.omissions.ranges.delays.ionosphere);
  EXPECT_TRUE(planned.plan.omissions.ranges.delays.ephemeris);
  EXPECT_EQ(planned.plan.omissions.ranges.bound_m, 0.0);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const auto pair = drive_pair(planned.config, planned.mission, *tape, planned.plan.omissions);
  ASSERT_TRUE(pair.ok());
  EXPECT_EQ(pair->violations, 0);
  EXPECT_GT(pair->epochs, 90);
}

// A real differential correction does not: the delay makes the receiver believe in another time of transmission.
TEST(Tolerated, WhatTheBaseSeesTooCancelsToMicrometresNotToTheBit) {
  const Planned planned("high", kShort, kDriving);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  GnssReplay replay(planned.config, planned.mission, *tape, {}, 17);
  const auto full = *replay.sensor(), less = *replay.sensor();
  less->leave_out(gnss::RangeOmissions{.delays = {.ionosphere = true, .troposphere = true}});
  double most_m = 0.0;
  for (const auto& epoch : replay.epochs()) {
    const auto a = replay.measure(*full, epoch, {}), b = replay.measure(*less, epoch, {});
    most_m = std::max(most_m, (a.fix.p_A_E - b.fix.p_A_E).norm());
  }
  EXPECT_GT(most_m, 0.0);
  EXPECT_LT(most_m, 1e-3);
}

TEST(Tolerated, EpochsWhosePromiseMightNotHoldAreMeasuredInFull) {
  const Planned planned("high", kShort, kDriving);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  GnssReplay replay(planned.config, planned.mission, *tape, {}, 17);
  const auto full = *replay.sensor();
  gnss::RangeOmissions all{.delays = {true, true, true, true, true}, .bound_m = 0.5, .most_gain = 0.0};
  const auto poor_geometry = *replay.sensor(), undecided = *replay.sensor();
  poor_geometry->leave_out(all);
  all.most_gain = 1e9;
  all.bound_m = 1e3;  // no chi-square statistic is that far from its threshold
  undecided->leave_out(all);
  for (const auto& epoch : replay.epochs()) {
    const auto a = replay.measure(*full, epoch, {});
    EXPECT_EQ(difference_m(a, replay.measure(*poor_geometry, epoch, {})), 0.0);
    EXPECT_EQ(difference_m(a, replay.measure(*undecided, epoch, {})), 0.0);
  }
  EXPECT_EQ(poor_geometry->counters().epochs_in_full, 17);
  EXPECT_EQ(undecided->counters().epochs_in_full, 17);
}

TEST(Tolerated, RunsOfOtherSeedsKeepToTheTolerance) {
  constexpr double kTolerance_m = 0.05;
  Planned planned("high", kShort, {Output::kPosition}, true, {{kRms, kTolerance_m}});
  ASSERT_TRUE(planned.plan.omissions.ranges.any());
  EXPECT_LE(planned.plan.figure_bounds.at(kRms), kTolerance_m);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const auto found = verify_plan(planned.config, planned.mission, *tape, planned.plan, 300);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(found->violations(), 0);
  EXPECT_TRUE(std::isfinite(found->tightness()));
  const auto rms = [&](const mission::testing::RecordedRun& run) {
    double square = 0.0;
    for (const auto& row : run.nav) square += (row.estimate.X_WB.p - row.X_WB_true.p).squaredNorm();
    return std::sqrt(square / static_cast<double>(run.nav.size()));
  };
  double most_m = 0.0;
  for (std::int64_t seed = 101; seed <= 120; ++seed) {
    planned.config.run.seed = seed;
    const double moved_m = std::abs(rms(planned.drive(true, &*tape)) - rms(planned.drive(false, &*tape)));
    EXPECT_LE(moved_m, planned.plan.figure_bounds.at(kRms)) << seed;
    most_m = std::max(most_m, moved_m);
  }
  EXPECT_GT(most_m, 0.0) << "what is left out acts";
}

}  // namespace
}  // namespace canyon::study
