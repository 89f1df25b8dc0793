#include "canyon/mission/scoring/scorer.h"

#include <nlohmann/json.hpp>

#include "canyon/mission/scoring/told_failure.h"
#include "canyon/study/results/results.h"
#include "canyon/tests/mission/screened_house.h"
#include "canyon/tests/mission/short_mission.h"
#include "canyon/tests/mission/summary_of.h"

namespace canyon::mission::testing {
namespace {

/// Drives a scorer along given plan positions instead of a vehicle.
class ScorerTest : public ::testing::Test {
 protected:
  ScorerTest()
      : config_(short_config("low", "low", "[success]\nstuck_after_s = 20.0")),
        mission_(*prepare(config_, scenes())),
        scene_(*mission_.scene),
        scorer_(config_, mission_, scene_) {}

  KinematicState at(const Eigen::Vector2d& p, double t_s) const {
    KinematicState state;
    state.t = mission_.start + t_s;
    state.X_WB = {rotation_from({1.5708, 0, 0}), {p.x(), p.y(), mission_.scene->ground(p.x(), p.y())->height_m + 0.1}};
    return state;
  }
  bool step(const Eigen::Vector2d& p, double speed, bool observing = false) {
    t_s_ += 0.5;
    return scorer_.step(at(p, t_s_), speed, true, observing);
  }

  MissionConfig config_;
  PreparedMission mission_;
  scene::SceneAt scene_;
  Scorer scorer_;
  double t_s_ = 0;
};

TEST_F(ScorerTest, SucceedsAfterAStopInSight) {
  step({213.9, 109.0}, 5.0);
  for (int i = 0; i < 11; ++i) EXPECT_TRUE(step({213.9, 150.0}, 0.0, true));
  scorer_.finish(at({213.9, 150.0}, t_s_), true);
  EXPECT_EQ(scorer_.outcome(), Outcome::kSuccess) << (scorer_.failure() ? scorer_.failure()->detail : "");
  EXPECT_TRUE(scorer_.waypoints()[0].reached);
  EXPECT_NEAR(scorer_.waypoints()[1].stopped_s, 5.5, 1e-9);
}

TEST_F(ScorerTest, AStopTooFarAwayIsAMissedWaypoint) {
  step({213.9, 109.0}, 5.0);
  for (int i = 0; i < 20; ++i) step({213.9, 146.0}, 0.0, true);
  scorer_.finish(at({213.9, 146.0}, t_s_), true);
  EXPECT_EQ(scorer_.outcome(), Outcome::kMissedWaypoint);
  EXPECT_EQ(scorer_.failure()->detail, "house: came within 4.0 m, stood there for 0.0 s");
}

TEST_F(ScorerTest, AStopTooShortIsAMissedWaypoint) {
  step({213.9, 109.0}, 5.0);
  for (int i = 0; i < 8; ++i) step({213.9, 150.0}, 0.0, true);
  scorer_.finish(at({213.9, 150.0}, t_s_), true);
  EXPECT_EQ(scorer_.outcome(), Outcome::kMissedWaypoint);
}

// 2026-11-22: "success" though the vehicle had come no nearer to the first waypoint than 16 m: plain ones were not
// scored.
TEST_F(ScorerTest, APlainWaypointThatWasNotReachedIsMissed) {
  step({213.9, 93.9}, 5.0);
  for (int i = 0; i < 11; ++i) step({213.9, 150.0}, 0.0, true);
  scorer_.finish(at({213.9, 150.0}, t_s_), true);
  EXPECT_TRUE(scorer_.waypoints()[1].reached);
  EXPECT_EQ(scorer_.outcome(), Outcome::kMissedWaypoint);
  EXPECT_EQ(scorer_.failure()->detail, "crossing: came within 16.0 m");
}

TEST_F(ScorerTest, OfSeveralMissedWaypointsTheFirstIsTold) {
  step({213.9, 60.0}, 5.0);
  scorer_.finish(at({213.9, 60.0}, t_s_), true);
  EXPECT_EQ(scorer_.outcome(), Outcome::kMissedWaypoint);
  EXPECT_EQ(scorer_.failure()->detail, "crossing: came within 49.9 m");
}

TEST_F(ScorerTest, DrivingIntoAHouseIsACollisionWithItsName) {
  bool ended = false;
  for (double x = 213.9; x < 245 && !ended; x += 0.3) ended = !step({x, 150.0}, 3.0);
  EXPECT_TRUE(ended);
  EXPECT_EQ(scorer_.outcome(), Outcome::kCollision);
  EXPECT_EQ(scorer_.failure()->detail.substr(0, 4), "hit ");
  const ToldFailure told = told_failure(*scorer_.failure());
  EXPECT_EQ(told.kind, "collision");
  EXPECT_EQ(told.in_scans_s, 0.0) << "nobody has scanned";
  EXPECT_TRUE(std::isnan(told.last_range_m));
}

// 2026-11-30: the house that it hit was a near miss, and some centimetres off at the least. By either collision check.
TEST(ScorerContact, WhatIsHitIsNoNearMissAndAtNoDistance) {
  const auto house = screened_house(0.0);
  const scene::SceneAt scene(*house);
  for (const std::string check : {"lines", "box"}) {
    const MissionConfig config = short_config("low", "low", "[success]\ncollision = \"" + check + "\"");
    const auto mission = prepare(config, scenes());
    ASSERT_TRUE(mission.ok());
    Scorer scorer(config, *mission, scene);
    KinematicState state;
    state.t = mission->start;
    bool on = true, was_near = false;
    for (int k = 0; k < 2000 && on; ++k) {
      state.t = mission->start + 0.01 * k;
      state.X_WB.p = {0.03 * k, 0.0, 0.0};
      scorer.follow(state, 3.0, {.speed_m_s = 3.0}, AutonomyState::kDriving, 0);
      was_near = was_near || scorer.encounters().near_misses > 0;
      on = scorer.step(state, 3.0, true, false);
    }
    ASSERT_EQ(scorer.outcome(), Outcome::kCollision) << check;
    EXPECT_EQ(scorer.failure()->detail, "hit building house");
    EXPECT_TRUE(was_near) << check;
    EXPECT_EQ(scorer.encounters().clearance_min_m, 0.0) << check;
    EXPECT_EQ(scorer.encounters().near_misses, 0) << check;
  }
}

// What a thing is stands before its name, unless the name says it.
TEST(NameWithKind, SaysWhatItIs) {
  const auto scene = screened_house(3.0);
  scene::SceneAt at(*scene);
  EXPECT_EQ(name_with_kind(at, 0), "terrain ground");
  EXPECT_EQ(name_with_kind(at, 1), "building house");
  EXPECT_EQ(name_with_kind(at, 2), "wall screen");
  const auto shape = [](scene::ObjectKind kind) {
    scene::SceneParts parts;
    parts.materials = scene::builtin_materials();
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("box", kind);
    mesh.box({0, 0, 1}, Eigen::Matrix3d::Identity(), {1, 1, 1}, mesh.material("concrete"));
    return std::make_shared<const scene::RigidShape>("box", kind, std::move(parts.mesh));
  };
  at.set_instances({{shape(scene::ObjectKind::kVehicle), "car 1", {Eigen::Quaterniond::Identity(), {-10, 0, 0}}},
                    {shape(scene::ObjectKind::kPerson), "person 2", {Eigen::Quaterniond::Identity(), {-20, 0, 0}}}});
  EXPECT_EQ(name_with_kind(at, 3), "other vehicle car 1");
  EXPECT_EQ(name_with_kind(at, 4), "person 2");
}

// The figures of summary.json and the words are made of the same sighting.
TEST(ToldFailureOf, ACollisionHasWhatScansHadShown) {
  Failure failure{.kind = Outcome::kCollision, .t_s = 8.1, .p_W = Eigen::Vector3d::Zero(), .detail = "hit vehicle 350"};
  EXPECT_EQ(told_failure(failure).in_scans_s, 0.0);
  failure.seen = Sighting{.range_m = 4.2, .stood_s = 1.4, .ago_s = 0.05};
  EXPECT_EQ(failure_line(told_failure(failure)),
            "hit a parked car (vehicle 350), seen by its LIDAR for the last 1.4 s, in the end 4.2 m off");
  failure.kind = Outcome::kStuck, failure.detail = "stood still for 30.0 s", failure.seen.reset();
  EXPECT_TRUE(std::isnan(told_failure(failure).in_scans_s));
}

TEST_F(ScorerTest, StandingStillWithoutReasonIsStuck) {
  bool go_on = true;
  for (int i = 0; i < 400 && go_on; ++i) go_on = step({213.9, 60.0}, 0.0);
  EXPECT_FALSE(go_on);
  EXPECT_EQ(scorer_.outcome(), Outcome::kStuck);
  EXPECT_NEAR(scorer_.failure()->t_s, config_.success.stuck_after_s, 1.0);
}

TEST_F(ScorerTest, NotBeingDoneIsATimeout) {
  step({213.9, 60.0}, 5.0);
  scorer_.finish(at({213.9, 60.0}, t_s_), false);
  EXPECT_EQ(scorer_.outcome(), Outcome::kTimeout);
}

// 2026-11-22: a run that the user's own limit ended early was a "timeout".
TEST(ScorerLimit, WhatTheUsersOwnLimitEndsIsStopped) {
  const auto outcome_with = [](const std::string& extra) {
    const MissionConfig config = short_config("low", "low", extra);
    const auto mission = prepare(config, scenes());
    EXPECT_TRUE(mission.ok());
    const scene::SceneAt scene(*mission->scene);
    Scorer scorer(config, *mission, scene);
    KinematicState state;
    state.t = mission->start + mission->time_limit_s;
    state.X_WB.p = {213.9, 60.0, mission->scene->ground(213.9, 60.0)->height_m};
    EXPECT_FALSE(scorer.step(state, 5.0, true, false)) << "the limit ends it";
    scorer.finish(state, false);
    return std::string(name(scorer.outcome())) + ": " + scorer.failure()->detail;
  };
  EXPECT_EQ(outcome_with("[time]\nlimit_s = 20.0"), "stopped: by [time] limit_s after 20.0 s");
  // One that is longer than the mission's own changes nothing.
  const std::string own = outcome_with("");
  EXPECT_EQ(own.rfind("timeout: not finished within ", 0), 0U) << own;
  EXPECT_EQ(outcome_with("[time]\nlimit_s = 9000.0"), own);
}

// Along x to 11 m in steps of half a metre. The autonomy takes "passed" for reached 2 m after it was nearest, at 1.5 m,
// and "beside" 12 m after that, at 5 m; to "ahead" it comes neither in truth nor as it believes. 3-4-5 and 5-12-13:
// exact.
TEST(ScorerWaypoints, ReachedBelievedAndMissedAreThreeVerdicts) {
  MissionConfig config;
  config.autonomy.waypoints = {{"passed", {-10.0, 1.5}, ""}, {"beside", {-2.0, 5.0}, ""}, {"ahead", {18.0, 0.0}, ""}};
  PreparedMission mission;
  mission.scene = screened_house(0);
  mission.time_limit_s = 60.0;
  const scene::SceneAt scene(*mission.scene);
  Scorer scorer(config, mission, scene);
  KinematicState moving;
  for (int k = 0; k <= 70; ++k) {
    const double x_m = 0.5 * k - 24.0;
    moving.t = mission.start + 0.1 * k;
    moving.X_WB.p = {x_m, 0.0, 0.0};
    EXPECT_TRUE(scorer.step(moving, 5.0, true, false)) << x_m;
    scorer.follow(moving, 5.0, {5.0, 0.0}, AutonomyState::kDriving, x_m < -8.0 ? 0 : x_m < 10.0 ? 1 : 2);
  }
  RecordedRun run;
  run.waypoints = scorer.waypoints();
  ASSERT_EQ(run.waypoints.size(), 3U);
  const double closest_m[] = {1.5, 5.0, 7.0};
  const bool believed[] = {true, true, false};
  const char* const verdict[] = {"reached", "believed", "missed"};
  const study::RunSummary summary = summary_of(run);
  const auto told = study::run_json(summary)["waypoints"];
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(run.waypoints[i].reached, i == 0) << verdict[i];
    EXPECT_EQ(run.waypoints[i].believed, believed[i]) << verdict[i];
    EXPECT_EQ(run.waypoints[i].closest_m, closest_m[i]) << verdict[i];
    EXPECT_EQ(told[i]["verdict"].get<std::string>(), verdict[i]);
  }
  EXPECT_EQ(run.waypoints[0].believed_at_m, 2.5);
  EXPECT_EQ(run.waypoints[1].believed_at_m, 13.0);
  EXPECT_TRUE(told[2]["believed_at_m"].is_null());
  EXPECT_EQ(summary.waypoints_reached, 1);
  EXPECT_EQ(summary.believed_not_reached, 1);
}

/// A scorer of these waypoints along x, plain ones, after a drive along these places, in steps of 1 m.
Scorer scored_along_x(const std::vector<double>& waypoints_m, const std::vector<double>& places_m) {
  static const auto scene = screened_house(0);
  static const scene::SceneAt at(*scene);
  MissionConfig config;
  for (const double x_m : waypoints_m) config.autonomy.waypoints.push_back({"", {x_m, 0.0}, ""});
  PreparedMission mission;
  mission.scene = scene;
  mission.time_limit_s = 600.0;
  Scorer scorer(config, mission, at);
  KinematicState moving;
  moving.t = mission.start;
  for (std::size_t i = 0; i + 1 < places_m.size(); ++i)
    for (double way_m = 0.0; way_m <= std::abs(places_m[i + 1] - places_m[i]); way_m += 1.0) {
      moving.t = moving.t + 0.2;
      moving.X_WB.p.x() = places_m[i] + std::copysign(way_m, places_m[i + 1] - places_m[i]);
      scorer.step(moving, 5.0, true, false);
    }
  scorer.finish(moving, true);
  return scorer;
}

// 2026-11-30: of eight laps the first alone reached all waypoints of the parking lot's circle.
TEST(ScorerWaypoints, APlaceThatComesAgainWantsAsManyVisits) {
  const auto detail = [](const std::vector<double>& places_m) {
    const Scorer scorer = scored_along_x({-20.0, -10.0, -20.0, -10.0}, places_m);
    return scorer.failure() ? scorer.failure()->detail : std::string();
  };
  EXPECT_EQ(detail({-20.0, -10.0, -20.0, -10.0}), "");
  EXPECT_EQ(detail({-20.0, -10.0, -20.0}), "waypoint 4: came within 4.0 m") << "since it left it";
  EXPECT_EQ(detail({-20.0, -10.0}), "waypoint 3: came within 4.0 m");
  EXPECT_EQ(detail({-20.0, -17.0, -20.0}), "waypoint 2: came within 7.0 m") << "it never left the first";
  // Two that follow one another in one place are of one visit.
  const auto reached = scored_along_x({-20.0, -20.0, -10.0, -20.0, -20.0}, {-25.0, -5.0}).waypoints();
  const bool expected[] = {true, true, true, false, false};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(reached[i].reached, expected[i]) << i;
}

/// A stop of 6 s at W's origin, before a house behind a screen of that height.
struct ScreenedStop {
  explicit ScreenedStop(double screen_m, double facade_share = 0.5) {
    config.success.facade_share = facade_share;
    config.autonomy.waypoints = {{"stop", {0.0, 0.0}, "house"}};
    mission.scene = screened_house(screen_m);
    mission.time_limit_s = 60.0;
    const scene::SceneAt scene(*mission.scene);
    Scorer scorer(config, mission, scene);
    KinematicState standing;
    for (int k = 1; k <= 12; ++k) {
      standing.t = mission.start + 0.5 * k;
      scorer.step(standing, 0.0, true, true);
    }
    scorer.finish(standing, true);
    outcome = scorer.outcome();
    detail = scorer.failure() ? scorer.failure()->detail : "";
    seen_share = scorer.waypoints()[0].facade_seen_share;
  }
  MissionConfig config;
  PreparedMission mission;
  Outcome outcome = Outcome::kSuccess;
  std::string detail;
  double seen_share = 0.0;
};

TEST(ScorerSight, AStopThatSeesJustOverHalfOfTheFacadeSucceeds) {
  const ScreenedStop stop(kHides12);
  EXPECT_EQ(stop.seen_share, 13.0 / 25);
  EXPECT_EQ(stop.outcome, Outcome::kSuccess) << stop.detail;
  EXPECT_EQ(ScreenedStop(kHides12, 13.0 / 25).outcome, Outcome::kSuccess) << "the share asked for is enough";
}

TEST(ScorerSight, AStopThatSeesJustUnderHalfOfTheFacadeHasNoLineOfSight) {
  const ScreenedStop stop(kHides13);
  EXPECT_EQ(stop.seen_share, 12.0 / 25);
  EXPECT_EQ(stop.outcome, Outcome::kNoLineOfSight);
  EXPECT_EQ(stop.detail, "stop: 48.0 % of the facade in sight");
}

TEST(ScorerScene, DrivingOverTheTerrainsEdgeLeavesTheScene) {
  MissionConfig config;
  config.vehicle.roughness = "none";
  config.autonomy.waypoints = {{"beyond", {0.0, 40.0}, ""}};
  PreparedMission mission;
  mission.scene = screened_house(0);
  mission.time_limit_s = 60.0;
  const scene::SceneAt scene(*mission.scene);
  Scorer scorer(config, mission, scene);
  Vehicle vehicle(config.vehicle, *mission.scene, 1, mission.start);  // heads north, the edge is at y = 30 m
  constexpr double kStep = 0.01, kSpeed = 5.0;
  bool go_on = true;
  for (int k = 1; k <= 1500 && go_on; ++k) {
    vehicle.advance({kSpeed, 0.0});
    go_on = scorer.step(vehicle.state(), vehicle.speed_m_s(), vehicle.on_terrain(), false);
  }
  EXPECT_FALSE(go_on);
  scorer.finish(vehicle.state(), false);
  EXPECT_EQ(scorer.outcome(), Outcome::kLeftScene);
  ASSERT_TRUE(scorer.failure());
  EXPECT_EQ(scorer.failure()->detail, "a wheel left the terrain");
  // The front axle passed the edge within the last step.
  const double front_m = scorer.failure()->p_W.y() + config.vehicle.wheelbase_m;
  EXPECT_GT(front_m, 30.0);
  EXPECT_LE(front_m, 30.0 + kStep * kSpeed);
}

}  // namespace
}  // namespace canyon::mission::testing
