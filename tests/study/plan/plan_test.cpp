#include "canyon/study/plan/plan.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/gnss/paths/need/path_question.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/mission/route_tape.h"
#include "canyon/study/plan/follow.h"
#include "canyon/study/plan/plan_file.h"
#include "canyon/study/plan/readers.h"
#include "canyon/study/plan/replay/replay.h"
#include "canyon/study/plan/replay/run_pair.h"
#include "canyon/study/plan/replay/tape_pieces.h"
#include "canyon/study/plan/verify.h"
#include "canyon/tests/study/plan/planned.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using mission::testing::RecordedRun;
using testing::kDriving;
using testing::Planned;

constexpr const char* kRegistered = "[time]\nlimit_s = 6.0\n[registration]\nmethod = \"pcl_shell_gicp\"\n";
constexpr const char* kEmpty =
    "[time]\nlimit_s = 6.0\n[scene]\nempty = true\n[[autonomy.waypoint]]\nname = \"1\"\np_m = [213.9, 109.9]\n";

TEST(Readers, RegistrationIsReadByMapsAndByAnAutonomyThatTakesItsPoses) {
  EXPECT_EQ(Planned("low", kRegistered, kDriving).verdict(kRegistration), Verdict::kNotNeeded);
  EXPECT_EQ(Planned("low", kRegistered, {Output::kMap}).verdict(kRegistration), Verdict::kNeeded);
  EXPECT_EQ(Planned("low", kRegistered, {Output::kClouds}).verdict(kMaps), Verdict::kNeeded);
  const Planned corrected("low", std::string(kRegistered) + "[autonomy]\nmap = \"registered\"\n", kDriving);
  EXPECT_EQ(corrected.verdict(kRegistration), Verdict::kNeeded);
  EXPECT_EQ(corrected.verdict(kKeyframes), Verdict::kNeeded);
  EXPECT_EQ(corrected.verdict(kMaps), Verdict::kNotNeeded);
}

TEST(Readers, ScansAreMadeForTheAutonomyOrForKeyframes) {
  const std::string follower = "[time]\nlimit_s = 6.0\n[autonomy]\nmodel = \"route_follower\"\n";
  EXPECT_EQ(Planned("low", "[time]\nlimit_s = 6.0\n", kDriving).verdict(kScans), Verdict::kNeeded);
  EXPECT_EQ(Planned("low", follower, {Output::kMap}).verdict(kScans), Verdict::kNeeded);
  const Planned blind("low", follower, kDriving);
  EXPECT_EQ(blind.verdict(kScans), Verdict::kNotNeeded);
  EXPECT_EQ(blind.drive(true).counters.at("lidar_rays"), 0);
}

// The closed loop: who drives sees the same, so the vehicle goes the same way.
TEST(Plan, WhatNobodyReadsChangesNoBitOfTheRestAndIsNotMade) {
  const Planned planned("high", kRegistered, kDriving);
  const RecordedRun full = planned.drive(false), less = planned.drive(true);
  ASSERT_EQ(full.nav.size(), less.nav.size());
  for (std::size_t i = 0; i < full.nav.size(); ++i) {
    EXPECT_EQ(full.nav[i].estimate.X_WB.p, less.nav[i].estimate.X_WB.p) << i;
    EXPECT_EQ(full.nav[i].X_WB_true.p, less.nav[i].X_WB_true.p) << i;
    EXPECT_EQ(full.nav[i].command.curvature_1_m, less.nav[i].command.curvature_1_m) << i;
  }
  for (const char* made : {"pcl_objects", "keyframes_registered", "map_cells_prior", "map_cells_registered"}) {
    EXPECT_GT(full.counters.at(made), 0) << made;
    EXPECT_EQ(less.counters.at(made), 0) << made;
  }
  EXPECT_TRUE(less.prior_map.empty());
  EXPECT_EQ(full.counters.at("lidar_scans"), less.counters.at("lidar_scans")) << "the autonomy looks";
  EXPECT_LT(less.counters.at("lidar_returns"), full.counters.at("lidar_returns")) << "but keeps what is near";
}

TEST(Plan, AnOpenFieldTracesNoRayAndIndexesNothing) {
  const Planned planned("high", kEmpty, kDriving);
  const RecordedRun full = planned.drive(false), less = planned.drive(true);
  EXPECT_GT(full.counters.at("gnss_occlusion_rays"), 0);
  EXPECT_EQ(less.counters.at("gnss_occlusion_rays"), 0);
  EXPECT_EQ(less.counters.at("gnss_facets_tested"), 0);
  ASSERT_EQ(full.nav.size(), less.nav.size());
  for (std::size_t i = 0; i < full.nav.size(); ++i)
    EXPECT_EQ(full.nav[i].estimate.X_WB.p, less.nav[i].estimate.X_WB.p) << i;
  EXPECT_THAT(less.warnings, ::testing::Not(::testing::Contains(::testing::HasSubstr("corridor"))));
}

// Wedges, scattering walls and clutter too have nothing to act with there; what a filter in the receiver makes of
// ranges cannot be said, so that these stay.
TEST(Plan, AnOpenFieldNeedsNothingOfTheStreetAsMeasured) {
  const Planned planned("high", kEmpty, kDriving, false, {}, "");
  ASSERT_EQ(planned.config.gnss.propagation.clutter.name, "street");
  for (const char* effect : {gnss::kDiffraction, gnss::kScattering, gnss::kClutter})
    EXPECT_EQ(planned.verdict(effect), Verdict::kNotNeeded) << effect;
  EXPECT_EQ(planned.verdict(gnss::kIonosphere), Verdict::kUndecidable);
  const RecordedRun full = planned.drive(false), less = planned.drive(true);
  EXPECT_EQ(less.counters.at("gnss_occlusion_rays"), 0);
  ASSERT_EQ(full.nav.size(), less.nav.size());
  for (std::size_t i = 0; i < full.nav.size(); ++i)
    EXPECT_EQ(full.nav[i].estimate.X_WB.p, less.nav[i].estimate.X_WB.p) << i;
  const Planned city("high", "[time]\nlimit_s = 2.0\n", kDriving, false, {}, "");
  for (const char* effect : {gnss::kScattering, gnss::kClutter})
    EXPECT_EQ(city.verdict(effect), Verdict::kUndecidable) << effect;
}

TEST(Plan, InAnOpenLoopNobodyReadsWhatTheAutonomySees) {
  const Planned planned("high", kRegistered, {Output::kPosition}, true);
  EXPECT_EQ(planned.verdict(kAutonomy), Verdict::kNotNeeded);
  EXPECT_EQ(planned.verdict(kScans), Verdict::kNotNeeded);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const RecordedRun full = planned.drive(false, &*tape), less = planned.drive(true, &*tape);
  EXPECT_GT(full.counters.at("lidar_rays"), 0);
  EXPECT_EQ(less.counters.at("lidar_rays"), 0);
  ASSERT_EQ(full.nav.size(), less.nav.size());
  for (std::size_t i = 0; i < full.nav.size(); ++i)
    EXPECT_EQ(full.nav[i].estimate.X_WB.p, less.nav[i].estimate.X_WB.p) << i;
  EXPECT_EQ(Planned("high", kRegistered, kDriving, true).verdict(kScans), Verdict::kNeeded) << "somebody asks";
}

// The ground there is nowhere steeper than 4.3 degrees: four of the sixteen beams, from 9 to 15 degrees upwards, climb
// out of the local grid before they could meet it, however the body is tilted on it. The first scans are fired in full.
TEST(Plan, InAnOpenFieldShotsUpwardsAreNotFired) {
  const Planned planned("high", kEmpty, kDriving);
  const RecordedRun full = planned.drive(false), less = planned.drive(true);
  EXPECT_LT(less.counters.at("lidar_rays"), 0.8 * static_cast<double>(full.counters.at("lidar_rays")));
  ASSERT_EQ(full.nav.size(), less.nav.size());
  for (std::size_t i = 0; i < full.nav.size(); ++i)
    EXPECT_EQ(full.nav[i].command.curvature_1_m, less.nav[i].command.curvature_1_m) << i;
}

// In a dense quarter nearly all may act: what is left out there would be a mistake of the bounds.
TEST(Plan, InADenseQuarterNineTenthsOfThePathEffectsAreKept) {
  const Planned planned("high", "[time]\nlimit_s = 6.0\n", kDriving);
  double kept_m = 0.0, all_m = 0.0;
  int effects = 0;
  for (const PlannedEffect& line : planned.plan.effects) {
    if (line.whole_run()) continue;
    all_m += line.end_m - line.start_m;
    kept_m += line.need.verdict == Verdict::kNotNeeded ? 0.0 : line.end_m - line.start_m;
    ++effects;
  }
  EXPECT_GE(effects, 5);
  EXPECT_GE(kept_m, 0.9 * all_m);
}

TEST(Plan, AVehicleBesideTheCorridorGetsEverythingBack) {
  Planned planned("high", kEmpty, kDriving);
  for (mission::PlannedPlace& place : planned.plan.omissions.corridor)
    if (place.segment.start_m > 5.0) place.segment.half_width_m = 0.0;
  const RecordedRun full = planned.drive(false), less = planned.drive(true);
  EXPECT_GT(less.counters.at("gnss_occlusion_rays"), 0);
  EXPECT_LT(less.counters.at("gnss_occlusion_rays"), full.counters.at("gnss_occlusion_rays"));
  EXPECT_THAT(less.warnings, ::testing::Contains(::testing::HasSubstr("left the plan's corridor at ")));
  EXPECT_EQ(full.nav.back().estimate.X_WB.p, less.nav.back().estimate.X_WB.p);
}

TEST(Verify, CountsWhatIsLeftOutWrongly) {
  Planned planned("high", "[time]\nlimit_s = 6.0\n", kDriving);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const auto right = verify_plan(planned.config, planned.mission, *tape, planned.plan, 60);
  ASSERT_TRUE(right.ok());
  EXPECT_EQ(right->violations(), 0);
  EXPECT_GE(right->epochs(), 60);

  // In a street of the city houses hide satellites and mirror them: a plan that denies it is found out.
  for (const char* effect : {"occlusion rays", "reflection off one wall", "diffraction at edges"}) {
    Plan wrong = planned.plan;
    wrong.effects = {
        {.need = {.effect = effect, .verdict = Verdict::kNotNeeded}, .segment = {}, .start_m = 0.0, .end_m = 1e4}};
    wrong.omissions = {};
    RouteSegment everywhere;
    everywhere.points_W = {{213.9, 30.0, 0.0}, {213.9, 150.0, 0.0}};
    everywhere.half_width_m = 4.0;
    everywhere.low_m = -100.0;
    everywhere.high_m = 200.0;
    wrong.omissions.corridor = {
        {everywhere, {.occlusion = true, .foliage = true, .diffraction = true, .most_reflections = 0}, {}}};
    const auto found = verify_plan(planned.config, planned.mission, *tape, wrong, 60);
    ASSERT_TRUE(found.ok());
    EXPECT_GT(found->violations(), 0) << effect;
  }
}

// 2026-11-22: whole runs were the first seconds of one seed, so that what nobody keeps was looked at on the first
// metres.
TEST(Verify, PiecesReachFromTheTapesStartToItsEnd) {
  Tape tape{.source = "test", .scene_hash = {}, .traffic = {}, .nodes = {}};
  for (int k = 0; k <= 10'000; ++k) {
    TapeNode node;
    node.motion.t.ns = 10'000'000LL * k;  // 100 s
    node.distance_m = 0.1 * k;
    tape.nodes.push_back(node);
  }
  const std::vector<Tape> pieces = spread_pieces(tape, 20.0);
  ASSERT_EQ(pieces.size(), 6u);
  double sum_s = 0.0;
  for (const Tape& piece : pieces) {
    EXPECT_EQ(piece.nodes.front().motion.t.ns, 0);
    EXPECT_EQ(piece.nodes.front().distance_m, 0.0);
    EXPECT_GE(piece.duration_s(), kShortestPiece_s);
    sum_s += piece.duration_s();
  }
  EXPECT_NEAR(sum_s, 20.0, 6 * 0.01);
  EXPECT_EQ(spread_pieces(tape, 1.0).size(), 1u);
  EXPECT_EQ(spread_pieces(tape, 1e3).front().nodes.size(), tape.nodes.size());
  EXPECT_EQ(spread_pieces(tape, 99.9).size(), 20u);
}

// 2026-11-22: places, times and headings came one with another, as on the tape.
TEST(Verify, EpochsAreDrawnFromAllThatAPlanHoldsFor) {
  const Planned planned("high", kEmpty, kDriving);
  const auto tape = mission::drive_route(planned.config, planned.mission);
  ASSERT_TRUE(tape.ok());
  const GnssReplay replay(planned.config, planned.mission, *tape, planned.plan.omissions, 60);
  double earliest_m = 1e9, latest_m = -1e9, last_s = 0.0;
  int quarters[4] = {};
  for (const auto& epoch : replay.epochs()) {
    const double t_s = epoch.t - planned.mission.start;
    EXPECT_GE(t_s, last_s);
    last_s = t_s;
    if (t_s > 0.5 * planned.plan.omissions.corridor_until_s) {
      earliest_m = std::min(earliest_m, epoch.p_A_W.y());
      latest_m = std::max(latest_m, epoch.p_A_W.y());
    }
    if (epoch.v_A_W.head<2>().norm() > 0.5) ++quarters[2 * (epoch.v_A_W.x() > 0.0) + (epoch.v_A_W.y() > 0.0)];
  }
  const double length_m = (tape->nodes.back().motion.X_WB.p - tape->nodes.front().motion.X_WB.p).norm();
  EXPECT_GT(latest_m - earliest_m, 0.5 * length_m) << "the first half of the way at the second half of the time";
  for (const int count : quarters) EXPECT_GT(count, 0);
  EXPECT_GT(last_s, 0.95 * planned.plan.omissions.corridor_until_s);
}

// 2026-11-22: C/N0 and Doppler of the second band were not looked at, nor a fix's velocity.
TEST(Verify, EveryFieldIsCompared) {
  gnss::GnssOutput output;
  output.epoch.observations.resize(1);
  const auto differs = [&](const auto& change) {
    gnss::GnssOutput other = output;
    change(other);
    return difference_m(output, other) > 0.0;
  };
  EXPECT_EQ(difference_m(output, output), 0.0);
  EXPECT_TRUE(differs([](auto& o) { o.epoch.observations[0].second.cn0_dbhz = 40.0; }));
  EXPECT_TRUE(differs([](auto& o) { o.epoch.observations[0].second.doppler_hz = 1.0; }));
  EXPECT_TRUE(differs([](auto& o) { o.epoch.observations[0].second.carrier_phase_cycles = 1.0; }));
  EXPECT_TRUE(differs([](auto& o) { o.epoch.observations[0].second.slipped = true; }));
  EXPECT_TRUE(differs([](auto& o) { o.epoch.observations[0].sigma_m = 1.0; }));
  EXPECT_TRUE(differs([](auto& o) { o.epoch.observations[0].correction_m = 1.0; }));
  EXPECT_TRUE(differs([](auto& o) { o.fix.clock_m = 1.0; }));
  EXPECT_TRUE(differs([](auto& o) { o.fix.dop.gdop = 1.0; }));
  GnssFix fix, faster;
  faster.v_A_E.x() = 1.0;
  EXPECT_TRUE(same(fix, fix));
  EXPECT_FALSE(same(fix, faster));
}

// 2026-11-22: --for beside a plan file was not looked at, and a run without maps followed for whoever reads them.
TEST(Follow, APlanThatLeavesOutWhatIsReadIsRefused) {
  const std::string path = canyon::testing::temporary_file("followed.plan");
  auto file = mission::MissionFile::parse(std::string(mission::testing::kShortMission) + "[time]\nlimit_s = 6.0\n",
                                          "short.toml");
  ASSERT_TRUE(file.ok());
  auto comparison = prepare_comparison(*file, plan_runs({"low"}, false));
  ASSERT_TRUE(comparison.ok());
  const auto& config = comparison->configs.front();
  const auto& mission = comparison->missions.front();
  const auto plan = make_plan(config, mission, {.fidelity = "low", .outputs = kDriving});
  ASSERT_TRUE(plan.ok());
  ASSERT_TRUE(write_text_file(path, plan_text(*plan, config, mission)).ok());
  const auto refused = follow_plan(path, std::vector<Output>{Output::kMap}, *comparison);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().str().substr(path.size()),
            ": is a plan for runs of which nobody reads map, expected --for outcome,position, or a plan made for what "
            "is to be read");
  EXPECT_EQ(refused.error().exit_code, 2);
  EXPECT_TRUE(follow_plan(path, std::vector<Output>{Output::kPosition}, *comparison).ok());
  comparison->plans.clear();
  comparison->configs.front() = *file->resolve("low");
  EXPECT_TRUE(follow_plan(path, std::nullopt, *comparison).ok());
}

class PlanFileTest : public ::testing::Test {
 protected:
  PlanFileTest() : planned_("high", kEmpty, kDriving), path_(canyon::testing::temporary_file("a.plan")) {
    text_ = plan_text(planned_.plan, planned_.config, planned_.mission);
  }
  std::string refusal(const std::string& text, const mission::MissionConfig& config) {
    EXPECT_TRUE(write_text_file(path_, text).ok());
    const auto plan = read_plan(path_, config, planned_.mission);
    EXPECT_FALSE(plan.ok());
    return plan.ok() ? "" : plan.error().str().substr(path_.size());
  }
  std::string with(std::string from, const std::string& to) {
    std::string text = text_;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  Planned planned_;
  std::string path_, text_;
};

TEST_F(PlanFileTest, ComesBackAsItWasWhateverTheSeed) {
  ASSERT_TRUE(write_text_file(path_, text_).ok());
  mission::MissionConfig other_seed = planned_.config;
  other_seed.run.seed = 77;
  const auto plan = read_plan(path_, other_seed, planned_.mission);
  ASSERT_TRUE(plan.ok()) << plan.error().str();
  EXPECT_EQ(plan_text(*plan, planned_.config, planned_.mission).size(), text_.size());
  ASSERT_EQ(plan->omissions.corridor.size(), planned_.plan.omissions.corridor.size());
  EXPECT_EQ(plan->omissions.corridor[0].paths, planned_.plan.omissions.corridor[0].paths);
  EXPECT_EQ(plan->omissions.corridor[0].segment.points_W, planned_.plan.omissions.corridor[0].segment.points_W);
  EXPECT_TRUE(plan->omissions.keyframes);
}

TEST_F(PlanFileTest, OfAnotherMissionSceneOrVersionIsRefused) {
  mission::MissionConfig other = planned_.config;
  other.gnss.mask_deg = 5.0;
  EXPECT_EQ(
      refusal(text_, other),
      ": is a plan for another mission (\"short\", fidelity high), expected one for this mission and fidelity, of the "
      "same keys but [run] seed and the same files");
  mission::PreparedMission other_files = planned_.mission;
  other_files.files.push_back({"brdc.rnx", "0123"});
  ASSERT_TRUE(write_text_file(path_, text_).ok());
  EXPECT_FALSE(read_plan(path_, planned_.config, other_files).ok()) << "the same names, other contents";
  EXPECT_THAT(refusal(with(planned_.mission.scene->hash(), "0123"), planned_.config),
              ::testing::StartsWith(": is a plan for another scene, expected one for the scene of this mission ("));
  EXPECT_THAT(refusal(with("\"version\": \"", "\"version\": \"9."), planned_.config),
              ::testing::StartsWith(": is a plan of canyon 9."));
  EXPECT_EQ(refusal(with("canyon-plan-4", "canyon-plan-3"), planned_.config),
            ": is a plan of the form canyon-plan-3, expected canyon-plan-4: make it again with canyon plan --write");
  EXPECT_EQ(refusal(with("\"autonomy\": false", "\"autonomy\": true"), planned_.config),
            ": is a plan for an open loop, in which nobody drives, expected --open-loop, or a plan made without it");
  EXPECT_EQ(refusal("{}", planned_.config), ": is no plan, expected a file of canyon plan --write");
  for (const auto& [from, to] :
       {std::pair("\"half_width_m\"", "\"width\""), std::pair("\"bound_m\": 0.0", "\"bound_m\": 0.1"),
        std::pair("\"tolerances\": [", "\"tolerances\": [7"), std::pair("\"outcome\"", "\"weather\"")})
    EXPECT_EQ(refusal(with(from, to), planned_.config), ": is no plan, expected a file of canyon plan --write") << to;
}

}  // namespace
}  // namespace canyon::study
