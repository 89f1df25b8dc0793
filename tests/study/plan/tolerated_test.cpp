// What acts by less than a tolerance: bounds, what is chosen within them, and that runs keep to them.
#include "canyon/study/plan/tolerated.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/random/random.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/study/plan/plan_file.h"
#include "canyon/study/plan/replay/replay.h"
#include "canyon/study/plan/replay/run_pair.h"
#include "canyon/study/plan/verify.h"
#include "canyon/study/results/tolerance.h"
#include "canyon/tests/study/plan/planned.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using mission::testing::RecordedRun;
using testing::kDriving;
using testing::Planned;

constexpr const char* kRms = "position_error_rms_m";
constexpr const char* kShort =
    "[time]\nlimit_s = 8.0\n[scene]\nempty = true\n[[autonomy.waypoint]]\nname = \"1\"\np_m = [213.9, 109.9]\n";

/// A chain that passes what moves the ranges on, twice as large.
PositionChain doubling() {
  return {.most_gain = 3.0, .seeds = {1}, .t_s = {0.0, 1.0}, .any = {2.0, 2.0}, .up = {1.0, 1.0}};
}

PlannedEffect candidate(const char* effect, double bound_m, std::int64_t saved_work) {
  return {.need = {.effect = effect, .verdict = Verdict::kNotNeeded, .bound = bound_m, .bound_unit = "m"},
          .segment = "whole run",
          .saved_work = saved_work};
}

TEST(Tolerated, AHalvedBoundFlipsTheVerdict) {
  const RandomStream stream(5, "test.bounds");
  for (std::uint64_t k = 0; k < 20; ++k) {
    const double bound_m = std::pow(10.0, stream.uniform(-5.0, 0.0, 0, k));
    Plan kept, left_out;
    kept.tolerances = left_out.tolerances = {{kRms, 2.0 * bound_m * stream.uniform(0.51, 0.99, 1, k)}};
    std::vector<PlannedEffect> right{candidate(gnss::kEphemeris, bound_m, 100)};
    std::vector<PlannedEffect> halved{candidate(gnss::kEphemeris, 0.5 * bound_m, 100)};
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
  std::vector<PlannedEffect> candidates{candidate(gnss::kIonosphereDifference, 0.02, 100),
                                        candidate(gnss::kEphemeris, 0.01, 200),
                                        candidate(gnss::kTroposphereDifference, 0.01, 150)};
  choose_within_tolerances(doubling(), candidates, plan);
  EXPECT_TRUE(plan.omissions.ranges.delays.ephemeris);
  EXPECT_TRUE(plan.omissions.ranges.delays.troposphere_difference);
  EXPECT_FALSE(plan.omissions.ranges.delays.ionosphere_difference) << "0.04 + 0.04 is more than 0.05";
  EXPECT_DOUBLE_EQ(plan.figure_bounds.at(kRms), 0.04);
  EXPECT_DOUBLE_EQ(plan.omissions.ranges.bound_m, 0.02);
  EXPECT_EQ(plan.omissions.ranges.most_gain, 3.0);
}

// 2026-11-22: ranked by CPU time as measured, a plan of the same mission was another one each time, and tolerance was
// spent on what saves nothing.
TEST(Tolerated, NoToleranceIsSpentOnWhatSavesNoWork) {
  Plan plan;
  plan.tolerances = {{kRms, 0.05}};
  std::vector<PlannedEffect> candidates{candidate(gnss::kEphemeris, 0.01, 0), candidate(gnss::kIonosphere, 0.02, 7)};
  choose_within_tolerances(doubling(), candidates, plan);
  EXPECT_FALSE(plan.omissions.ranges.delays.ephemeris);
  EXPECT_TRUE(plan.omissions.ranges.delays.ionosphere);
  EXPECT_DOUBLE_EQ(plan.figure_bounds.at(kRms), 0.04);
  EXPECT_THAT(candidates.back().need.reason, ::testing::HasSubstr("saves no work"));
}

// 2026-11-22: NaN is not above a tolerance, and so was within it.
TEST(Tolerated, WhatIsNotKnownIsNotWithinATolerance) {
  Plan plan;
  plan.tolerances = {{kRms, 0.05}};
  PositionChain unknown = doubling();
  unknown.any.back() = kNaN;
  std::vector<PlannedEffect> candidates{candidate(gnss::kEphemeris, 1e-6, 100)};
  choose_within_tolerances(unknown, candidates, plan);
  EXPECT_EQ(candidates[0].need.verdict, Verdict::kNeeded);
  EXPECT_FALSE(plan.omissions.ranges.any());
}

// 2026-11-22: micrometres of the estimate change a command, and a vehicle in traffic then goes another way.
TEST(Tolerated, InAClosedLoopAndBesideOtherOutputsWhatActsIsKept) {
  const Planned closed("high", kShort, {Output::kPosition}, false, {{kRms, 0.05}});
  EXPECT_EQ(closed.verdict(gnss::kIonosphere), Verdict::kUndecidable);
  EXPECT_FALSE(closed.plan.omissions.ranges.any());
  for (const Output beside : {Output::kOutcome, Output::kMap, Output::kClouds}) {
    const Planned planned("high", kShort, {Output::kPosition, beside}, true, {{kRms, 0.05}});
    EXPECT_EQ(planned.verdict(gnss::kTroposphere), Verdict::kUndecidable) << name(beside);
    EXPECT_FALSE(planned.plan.omissions.ranges.any()) << name(beside);
  }
}

// 2026-11-23: the replay of the filter has no wheels, and its gains were taken for those of a filter that has.
TEST(Tolerated, AFilterThatMeasuresWithMoreThanThePlansReplayIsUndecidable) {
  for (const char* more : {"odometer", "velocity", "barometer", "standstill"}) {
    const Planned planned("high",
                          std::string(kShort) + "[fusion]\nmeasurements = [\"position\", \"" + more +
                              "\"]\nacceptance = \"accept_all\"\n",
                          {Output::kPosition}, true, {{kRms, 0.05}});
    EXPECT_EQ(planned.verdict(gnss::kTroposphere), Verdict::kUndecidable) << more;
    EXPECT_FALSE(planned.plan.omissions.ranges.any()) << more;
  }
}

TEST(Tolerated, BoundsHoldAlongOneTapeAndInNoClosedLoop) {
  const Planned planned("high", kShort, {Output::kPosition}, true, {{kRms, 0.05}});
  ASSERT_GT(planned.plan.omissions.ranges.bound_m, 0.0);
  const std::string path = canyon::testing::temporary_file("tolerated.plan");
  ASSERT_TRUE(write_text_file(path, plan_text(planned.plan, planned.config, planned.mission)).ok());
  auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const auto read = read_plan(path, planned.config, planned.mission, &*tape);
  ASSERT_TRUE(read.ok()) << read.error().str();
  EXPECT_EQ(read->seeds, planned.plan.seeds);
  EXPECT_EQ(read->omissions.strapdown, planned.plan.omissions.strapdown);
  EXPECT_TRUE(read->omissions.strapdown.coning);
  const auto closed = read_plan(path, planned.config, planned.mission);
  ASSERT_FALSE(closed.ok());
  EXPECT_EQ(closed.error().str().substr(path.size()),
            ": lets the estimate move within a tolerance, and in a closed loop the vehicle with it, expected "
            "--open-loop, or a plan made without --tolerance");
  tape->nodes.back().motion.X_WB.p.x() += 1e-6;
  const auto other = read_plan(path, planned.config, planned.mission, &*tape);
  ASSERT_FALSE(other.ok());
  EXPECT_THAT(other.error().str().substr(path.size()),
              ::testing::StartsWith(": has bounds that hold along another tape ("));
}

// 2026-11-22: one entry a fix, so that a minute without fixes counted as one of them, and nothing after the last.
TEST(PositionChain, GoesFromRowToRowToTheEndOfTheTape) {
  const Planned planned("high", std::string(kShort) + "[run]\nwithhold_fixes_after_s = 3.0\n", {Output::kPosition},
                        true);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const auto chain = position_chain(planned.config, planned.mission, *tape, 1);
  ASSERT_TRUE(chain.ok());
  const RecordedRun run = planned.drive(false, &*tape);
  ASSERT_EQ(chain->t_s.size(), run.nav.size());
  std::size_t last_fix = 0;
  for (std::size_t i = 0; i < run.nav.size(); ++i) {
    EXPECT_DOUBLE_EQ(chain->t_s[i], run.nav[i].t - planned.mission.start) << i;
    if (chain->t_s[i] < 3.0) last_fix = i;
  }
  EXPECT_GT(chain->t_s.back() - chain->t_s[last_fix], 4.0);
  EXPECT_GT(chain->any.back(), chain->any[last_fix]) << "without fixes a moved velocity carries the place away";
  double square = 0.0;
  for (const double any : chain->any) square += any * any;
  EXPECT_DOUBLE_EQ(chain->rms(), std::sqrt(square / static_cast<double>(run.nav.size())));
}

// 2026-11-22: which fixes there are depends on the seed's noise, and the plan was made of one.
TEST(PositionChain, IsTheLargestOfSeveralSeeds) {
  Planned planned("high", "[time]\nlimit_s = 8.0\n", {Output::kPosition}, true);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const auto several = position_chain(planned.config, planned.mission, *tape, 3);
  ASSERT_TRUE(several.ok());
  EXPECT_EQ(several->seeds.size(), 3u);
  std::vector<double> largest(several->any.size(), 0.0);
  bool differ = false;
  for (int k = 0; k < 3; ++k) {
    const auto one = position_chain(planned.config, planned.mission, *tape, 1);
    ASSERT_TRUE(one.ok());
    ASSERT_EQ(one->any.size(), largest.size());
    for (std::size_t i = 0; i < largest.size(); ++i) {
      differ = differ || (k > 0 && one->any[i] != largest[i]);
      largest[i] = std::max(largest[i], one->any[i]);
    }
    ++planned.config.run.seed;
  }
  EXPECT_TRUE(differ);
  // The share of epochs that count is taken of all seeds together, so that single ones may differ by one epoch.
  int below = 0;
  for (std::size_t i = 0; i < largest.size(); ++i) below += several->any[i] < 0.99 * largest[i] ? 1 : 0;
  EXPECT_LE(below, static_cast<int>(largest.size()) / 5);
}

// 2026-11-22: of two values the last won.
TEST(Tolerated, AFigureStandsThereOnce) {
  const auto twice = tolerances_of({"position_error_rms_m=1", "position_error_rms_m=2"}, "--tolerance");
  ASSERT_FALSE(twice.ok());
  EXPECT_EQ(twice.error().str(),
            "--tolerance: position_error_rms_m: stands there twice, expected one value for a figure");
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

// What the filter's integrator leaves out acts in every step: its own unit is the attitude's drift. The Earth's is
// known to all digits, so that half of it is broken; of the estimate the bound is twice what was found along three
// seeds.
TEST(Tolerated, WhatTheFiltersIntegratorLeavesOutIsBoundedAndVerified) {
  const Planned planned("high", kShort, {Output::kPosition}, true, {{kRms, 1.0}});
  EXPECT_TRUE(planned.plan.omissions.strapdown.coning);
  EXPECT_TRUE(planned.plan.omissions.strapdown.earth_rate);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const auto verified = [&](const Plan& plan) {
    auto found = verify_plan(planned.config, planned.mission, *tape, plan, 160);
    EXPECT_TRUE(found.ok());
    return *std::move(found);
  };
  const auto violations = [](const Verification& found, const std::string& effect) {
    for (const VerifiedEffect& one : found.effects)
      if (one.effect == effect) return one.violations;
    ADD_FAILURE() << effect;
    return std::int64_t{-1};
  };
  const Verification right = verified(planned.plan);
  EXPECT_EQ(right.violations(), 0);
  for (const VerifiedEffect& one : right.effects)
    EXPECT_TRUE(one.unit != "deg/h" || one.largest_difference > 0.0) << one.effect;
  Plan wrong = planned.plan;
  for (PlannedEffect& line : wrong.effects) {
    if (line.need.effect != fusion::kEarthRate) continue;
    EXPECT_NEAR(line.need.bound, 15.041, 0.001);
    line.need.bound *= 0.5;
  }
  for (double& bound_m : wrong.epoch_bound_m) bound_m *= 0.1;
  const Verification found = verified(wrong);
  EXPECT_GT(violations(found, "turning of the Earth: attitude"), 0);
  EXPECT_EQ(violations(found, "coning and sculling: attitude"), 0);
  EXPECT_GT(violations(found, "all that acts by less: estimates"), 0);
}

TEST(Tolerated, WhatAnIntegratorDoesNotSayIsKept) {
  const Planned planned("high", std::string(kShort) + "[fusion]\nintegrator = \"three_sample\"\n", {Output::kPosition},
                        true, {{kRms, 1.0}});
  EXPECT_FALSE(planned.plan.omissions.strapdown.any());
  EXPECT_TRUE(planned.plan.omissions.ranges.any());
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

/// What a plan of a tolerance leaves out moves the figure of seeds that did not choose it by less than its bound.
void expect_kept_by_seeds(std::int64_t from, std::int64_t to) {
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
  for (std::int64_t seed = from; seed < to; ++seed) {
    planned.config.run.seed = seed;
    const double moved_m = std::abs(rms(planned.drive(true, &*tape)) - rms(planned.drive(false, &*tape)));
    EXPECT_LE(moved_m, planned.plan.figure_bounds.at(kRms)) << seed;
    most_m = std::max(most_m, moved_m);
  }
  EXPECT_GT(most_m, 0.0) << "what is left out acts";
}

TEST(Tolerated, RunsOfOtherSeedsKeepToTheTolerance) {
  expect_kept_by_seeds(101, 105);
}
TEST(ToleratedNightly, RunsOfTwentyOtherSeedsKeepToTheTolerance) {
  expect_kept_by_seeds(101, 121);
}

}  // namespace
}  // namespace canyon::study
