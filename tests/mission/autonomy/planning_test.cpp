#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "canyon/mission/autonomy/planning/local_planner.h"
#include "canyon/mission/autonomy/planning/recovery.h"
#include "canyon/mission/autonomy/planning/speed_rule.h"
#include "canyon/tests/mission/autonomy/planning_parts.h"

namespace canyon::mission {
namespace {

using testing::add_wall;
using testing::default_planner;
using testing::default_tracker;
using testing::defaults;

PlanLine straight(double length_m) {
  PlanLine line;
  for (double x = 0.0; x <= length_m; x += PlanLine::kSpacing_m) line.points_O.emplace_back(x, 0.0);
  return line;
}

TEST(PlanPose, GoesAlongAnArc) {
  const PlanPose start{{3.0, -2.0}, 0.3};
  constexpr double kRadius = 5.0;
  const PlanPose half_turn = start.along(1.0 / kRadius, kRadius * std::numbers::pi);
  // Across the circle; n eps scale.
  EXPECT_NEAR(half_turn.p_m.x(), 3.0 - 2.0 * kRadius * std::sin(0.3), 1e-14);
  EXPECT_NEAR(half_turn.p_m.y(), -2.0 + 2.0 * kRadius * std::cos(0.3), 1e-14);
  EXPECT_NEAR(half_turn.yaw_rad, 0.3 + std::numbers::pi, 1e-14);
  const PlanPose there_and_back = start.along(0.2, 4.0).along(0.2, -4.0);
  EXPECT_NEAR((there_and_back.p_m - start.p_m).norm(), 0.0, 1e-14);
}

// Against every cell in turn.
TEST(BlockedCells, ClearanceIsThatOfTheBodysRectangle) {
  std::vector<Eigen::Vector2d> cells;
  for (int i = 0; i < 400; ++i) cells.emplace_back(20.0 * std::sin(1.7 * i), 20.0 * std::sin(2.9 * i + 1.0));
  const KnownVehicle vehicle;
  const BlockedCells blocked({1.0, 2.0}, cells);
  ASSERT_EQ(blocked.all().size(), cells.size());
  for (int i = 0; i < 200; ++i) {
    const PlanPose body{{15.0 * std::sin(0.9 * i), 15.0 * std::sin(0.7 * i)}, 0.37 * i};
    double nearest = 2.0;
    for (const Eigen::Vector2d& cell : cells) {
      const Eigen::Vector2d d = Eigen::Rotation2Dd(-body.yaw_rad) * (cell - body.p_m);
      const double dx = std::max({vehicle.rear_m - d.x(), d.x() - vehicle.front_m, 0.0});
      const double dy = std::max(std::abs(d.y()) - vehicle.half_width_m, 0.0);
      nearest = std::min(nearest, std::hypot(dx, dy));
    }
    EXPECT_NEAR(blocked.clearance_m(body, vehicle, 2.0), nearest, 1e-12);
  }
}

// A point of the very circle that it drives on is seen along an arc of that circle.
TEST(Trackers, PurePursuitKeepsToACircle) {
  constexpr double kRadius = 12.0;
  PlanLine circle;
  for (double s = 0.0; s < 20.0; s += PlanLine::kSpacing_m)
    circle.points_O.emplace_back(kRadius * std::sin(s / kRadius), kRadius * (1.0 - std::cos(s / kRadius)));
  EXPECT_NEAR(default_tracker("pure_pursuit")->curvature_1_m(circle, 0, {}, 4.0), 1.0 / kRadius, 1e-12);
}

TEST(Trackers, StanleySteersAtTheFrontAxle) {
  const auto stanley = default_tracker("stanley");
  const PlanLine line = straight(30.0);
  EXPECT_NEAR(stanley->curvature_1_m(line, 0, {}, 3.0), 0.0, 1e-15);
  // One metre left of it at 3 m/s, decay 1 s, softening 1 m/s: atan(1 / 4) to the right.
  EXPECT_NEAR(stanley->curvature_1_m(line, 0, {{0.0, 1.0}, 0.0}, 3.0), -0.25 / KnownVehicle{}.wheelbase_m, 1e-15);
}

TEST(Trackers, BothComeBackToTheLine) {
  const KnownVehicle vehicle;
  const PlanLine line = straight(80.0);
  for (const char* name : {"pure_pursuit", "stanley"}) {
    const auto steers = default_tracker(name);
    MovingBody body{{{0.0, 2.0}, 0.2}, 4.0, 0.0};
    std::size_t nearest = 0;
    for (int i = 0; i < 1500; ++i) {
      nearest = line.nearest(body.pose.p_m, nearest);
      const double kappa = steers->curvature_1_m(line, nearest, body.pose, body.speed_m_s);
      body.steering_rad = steered_rad(body.steering_rad, kappa, 0.01, vehicle);
      body.pose = body.pose.along(std::tan(body.steering_rad) / vehicle.wheelbase_m, 0.04);
    }
    EXPECT_LT(std::abs(body.pose.p_m.y()), 0.05) << name;
    EXPECT_LT(std::abs(body.pose.yaw_rad), 0.02) << name;
  }
}

// The bumper, not the rear axle, must stay clear: 10 - 2.2 - 0.3 m to a wall 10 m ahead.
TEST(DrivenArc, EndsWhereTheBumperDoes) {
  std::vector<Eigen::Vector2d> wall;
  for (double y = -3.0; y <= 3.0; y += 0.2) wall.emplace_back(10.0, y);
  const BlockedCells blocked({0.0, 0.0}, wall);
  const DrivenArc arc = drive_in_thought(straight(40.0), {{}, 3.0, 0.0}, 20.0, {.least_m = 0.3, .comfort_m = 0.8},
                                         *default_tracker("pure_pursuit"), blocked, {});
  EXPECT_FALSE(arc.ends_free);
  EXPECT_LE(arc.free_m, 7.5);
  EXPECT_GT(arc.free_m, 7.5 - DrivenArc::kStep_m - 1e-9);
  EXPECT_EQ(free_along({}, 0.0, 20.0, {}, blocked, {}), arc.free_m);
  EXPECT_EQ(free_along({}, 0.0, -20.0, {}, blocked, {}), 20.0);
}

// A post 0.2 m beside the way is too near, and not touched; one ahead is touched, all but 0.1 m of it.
TEST(DrivenArc, TellsTooNearFromTouched) {
  const KnownVehicle vehicle;
  const MovingBody body{{}, 5.0, 0.0};
  const auto driven = [&](const Eigen::Vector2d& post) {
    return drive_in_thought(straight(40.0), body, 20.0, {.least_m = 0.3, .comfort_m = 0.8},
                            *default_tracker("pure_pursuit"), BlockedCells({0.0, 0.0}, {post}), vehicle);
  };
  const DrivenArc beside = driven({vehicle.front_m + 2.0, vehicle.half_width_m + 0.2});
  EXPECT_EQ(beside.free_m, 1.75);  // sqrt(0.3^2 - 0.2^2) = 0.22 m before it, in steps of 0.25 m
  EXPECT_EQ(beside.untouched_m, std::ceil(halting_way_m(body, vehicle) / DrivenArc::kStep_m) * DrivenArc::kStep_m);
  EXPECT_FALSE(beside.ends_free);
  const DrivenArc ahead = driven({vehicle.front_m + 2.2, 0.0});
  EXPECT_EQ(ahead.free_m, 1.75);
  EXPECT_EQ(ahead.untouched_m, 2.0);
  EXPECT_EQ(ahead.curvature_1_m.size(), 7U);
  EXPECT_TRUE(driven({30.0, 0.0}).ends_free);
}

// 2026-11-26: one cell at its bumper made the least clearance nothing for two metres, of the wall a metre behind it
// too: three of 29 runs crept into a wall in plain view.
TEST(Room, WhatStandsTooNearGivesNothingElseAway) {
  const KnownVehicle vehicle;
  for (const double touching_m : {0.0, 0.04, 0.2}) {
    std::vector<Eigen::Vector2d> cells{{vehicle.front_m + touching_m, 0.6}};
    add_wall(cells, {4.1, -6.0}, {4.1, 6.0});
    const BlockedCells blocked({0.0, 0.0}, cells);
    for (const double curvature : {-0.3, 0.0, 0.3})
      EXPECT_EQ(free_along({}, curvature, 5.0, {}, blocked, vehicle), 0.0) << touching_m << " " << curvature;
    EXPECT_EQ(free_along({}, 0.0, -5.0, {}, blocked, vehicle), 5.0) << touching_m;
    // Beside its tail it keeps nobody from going on, as far as the wall lets it.
    cells[0] = {vehicle.rear_m + 0.2, vehicle.half_width_m + touching_m};
    EXPECT_EQ(free_along({}, 0.0, 5.0, {}, BlockedCells({0.0, 0.0}, cells), vehicle), 1.5) << touching_m;
  }
}

TEST(Room, ComesNoNearerAheadScanByScan) {
  const KnownVehicle vehicle;
  std::vector<Eigen::Vector2d> wall;
  add_wall(wall, {-10.0, 1.1}, {30.0, 1.1});
  const BlockedCells blocked({0.0, 0.0}, wall);
  PlanPose body{{0.0, 0.0}, 0.05};  // 0.24 m from its front left corner, and towards it
  for (int scan = 0; scan < 100; ++scan)
    if (free_along(body, 0.0, 1.0, {}, blocked, vehicle) > 0.0) body = body.along(0.0, 0.1);
  EXPECT_GE(blocked.clearance_m(body, vehicle, 1.0), 0.14);  // half the clearance, a step of 0.1 m later
}

// Its steering turns by 45 degrees a second at most, so that a line that turns away at once is left.
TEST(DrivenArc, KeepsToTheVehiclesSteering) {
  PlanLine corner;
  for (double x = 0.0; x < 3.0; x += PlanLine::kSpacing_m) corner.points_O.emplace_back(x, 0.0);
  for (double y = 0.0; y < 20.0; y += PlanLine::kSpacing_m) corner.points_O.emplace_back(3.0, y);
  const KnownVehicle vehicle;
  const DrivenArc arc =
      drive_in_thought(corner, {{}, 5.0, 0.0}, 8.0, {}, *default_tracker("pure_pursuit"), BlockedCells{}, vehicle);
  const double most = std::tan(vehicle.max_steering_rad) / vehicle.wheelbase_m;
  double steering = 0.0;
  for (const float kappa : arc.curvature_1_m) {
    EXPECT_LE(std::abs(static_cast<double>(kappa)), most + 1e-6);  // single precision
    const double next = std::atan(static_cast<double>(kappa) * vehicle.wheelbase_m);
    EXPECT_LE(std::abs(next - steering), vehicle.max_steering_rate_rad_s * DrivenArc::kStep_m / 5.0 + 1e-6);
    steering = next;
  }
}

// v tau + v^2 / (2 b) = d.
TEST(SpeedRules, HaltWithinWhatIsFree) {
  const auto rule = model_row(speed_rules(), "stopping_distance").make(defaults().speed.model.own);
  SpeedTask task{.route_m_s = 30.0, .free_to_end = false, .free_m = 8.5, .seen_m = 100.0, .braking_m_s2 = 1.5};
  const double v = rule->allowed_m_s(task);
  EXPECT_NEAR(0.3 * v + v * v / 3.0, 8.5 - 0.5, 1e-12);
  task.free_m = 0.5;
  EXPECT_EQ(rule->allowed_m_s(task), 0.0);
  task = {.route_m_s = 30.0, .free_to_end = true, .seen_m = 12.0, .braking_m_s2 = 1.5};
  const double seen = rule->allowed_m_s(task);
  EXPECT_NEAR(0.3 * seen + seen * seen / 3.0, 12.0, 1e-12);
  const float bend[] = {0.0F, 0.0F, 0.25F};
  task.seen_m = 100.0;
  task.curvature_1_m = bend;
  EXPECT_NEAR(rule->allowed_m_s(task), std::sqrt(1.2 / 0.25 + 2.0 * 1.5 * 0.5), 1e-12);
}

/// When something is done, and what, by a vehicle that stands before a wall with all room behind it, and whose plans
/// lead nowhere; looked at every half second until the mission would count as stuck.
std::optional<std::pair<double, DriveCommand>> done_before_a_wall(const char* recovery_name, bool should_drive_on) {
  std::vector<Eigen::Vector2d> wall;
  add_wall(wall, {4.0, -6.0}, {4.0, 6.0});
  const BlockedCells blocked({0.0, 0.0}, wall);
  const KnownVehicle vehicle;
  const LocalPlan nowhere;
  const auto recovery = model_row(recoveries(), recovery_name).make(defaults().recovery.model.own);
  for (double t_s = 0.0; t_s <= 90.0; t_s += 0.5)
    if (const auto command = recovery->act({t_s, should_drive_on, 0.0, nowhere, {}, {}, blocked, vehicle}))
      return std::pair(t_s, *command);
  return std::nullopt;
}

// "back_up" reverses at its 1 m/s once it has waited for its 2 s.
TEST(Recoveries, WaitNeverReversesWhereBackUpDoes) {
  const auto backed = done_before_a_wall("back_up", true);
  ASSERT_TRUE(backed.has_value());
  EXPECT_EQ(backed->first, 2.0);
  EXPECT_EQ(backed->second.speed_m_s, -1.0);
  EXPECT_FALSE(done_before_a_wall("wait", true).has_value());
  for (const char* name : {"back_up", "wait"}) EXPECT_FALSE(done_before_a_wall(name, false).has_value()) << name;
}

/// Drives by plans that are made anew every half metre until the body is within half a metre of the lane's middle;
/// returns the way, at most 60 m.
double way_back_m(LocalPlanner& planner, const Path& route, MovingBody body, double lane_m, const Tracker& steers) {
  const KnownVehicle vehicle;
  const BlockedCells nothing;
  double way_m = 0.0;
  while (std::abs(body.pose.p_m.y() - lane_m) > 0.5 && way_m < 60.0) {
    const LocalPlan plan =
        planner.plan({route, body.pose.p_m.x(), Eigen::Vector2d::Zero(), lane_m, body, nothing, steers, vehicle});
    std::size_t nearest = 0;
    for (int i = 0; i < 10; ++i) {
      nearest = plan.line.nearest(body.pose.p_m, nearest);
      const double kappa = steers.curvature_1_m(plan.line, nearest, body.pose, body.speed_m_s);
      body.steering_rad = steered_rad(body.steering_rad, kappa, 0.05 / body.speed_m_s, vehicle);
      body.pose = body.pose.along(std::tan(body.steering_rad) / vehicle.wheelbase_m, 0.05);
      way_m += 0.05;
    }
  }
  return way_m;
}

// 2026-11-23: change_cost (0.8) above offset_cost (0.6) kept it beside the street for the rest of the mission after one
// evasion. It is asked to be within 0.5 m of its lane again 30 m after one, at any speed.
class EachPlanner : public ::testing::TestWithParam<const char*> {};

TEST_P(EachPlanner, GoesBackToTheLaneOnceItIsFree) {
  const Path route({{0.0, 0.0}, {200.0, 0.0}}, 6.5);
  const auto steers = default_tracker("pure_pursuit");
  const KnownVehicle vehicle;
  for (const double blocked_to_m : {0.5, 1.5, 2.0}) {
    const auto planner = default_planner(GetParam());
    std::vector<Eigen::Vector2d> across;
    for (double y = -8.0; y <= blocked_to_m; y += 0.2) across.emplace_back(22.0, y);
    const BlockedCells blocked({0.0, 0.0}, across);
    const LocalPlan evading = planner->plan(
        {route, 10.0, Eigen::Vector2d::Zero(), 0.0, {{{10.0, 0.0}, 0.0}, 2.0, 0.0}, blocked, *steers, vehicle});
    EXPECT_TRUE(evading.arc.ends_free) << blocked_to_m;
    const double evaded_m = std::ceil(2.0 * (blocked_to_m + vehicle.half_width_m + 0.3)) / 2.0;
    for (const double speed_m_s : {1.0, 3.0, 5.0}) {
      const MovingBody past{{{30.0, evaded_m}, 0.0}, speed_m_s, 0.0};
      EXPECT_LE(way_back_m(*planner, route, past, 0.0, *steers), 30.0) << blocked_to_m << " " << speed_m_s;
      // Where the lane itself is moved by what is seen, that is where it goes.
      EXPECT_LE(way_back_m(*planner, route, past, 1.0, *steers), 30.0) << blocked_to_m << " " << speed_m_s;
    }
  }
}

/// The plan of a vehicle at 5 m/s that an estimate puts so far to the left of its lane, with a wall between the two, in
/// parallel and so far from the vehicle's middle, and things `more`.
LocalPlan plan_beside_a_wall(const char* planner_name, double beside_m, double from_wall_m,
                             std::vector<Eigen::Vector2d> more = {}) {
  const Path route({{0.0, 0.0}, {200.0, 0.0}}, 6.5);
  add_wall(more, {0.0, beside_m - from_wall_m}, {100.0, beside_m - from_wall_m});
  const BlockedCells blocked({10.0, beside_m}, more);
  const auto planner = default_planner(planner_name);
  return planner->plan({route,
                        10.0,
                        Eigen::Vector2d::Zero(),
                        0.0,
                        {{{10.0, beside_m}, 0.0}, 5.0, 0.0},
                        blocked,
                        *default_tracker("pure_pursuit"),
                        KnownVehicle{}});
}

// 2026-11-26: all ways that it looked at led to within 3.5 m of where it took its lane to be, through the wall; of 20
// missions with a receiver's errors 14 ended in what had stood before it for ten seconds.
TEST_P(EachPlanner, GoesStraightOnWhereItsLaneSeemsBehindAWall) {
  for (const double beside_m : {14.0, 23.0, 26.0, 60.0}) {
    const LocalPlan plan = plan_beside_a_wall(GetParam(), beside_m, 1.8);
    EXPECT_TRUE(plan.arc.ends_free) << beside_m;
    EXPECT_GE(plan.offset_m, beside_m - 1.0) << beside_m;
  }
}

// 2026-11-26: nearer to a wall than it should be, every way was asked to lead away from it within the first metre,
// which none does at 5 m/s; so all counted as blocked, and it braked and steered for its lane, into the wall.
TEST_P(EachPlanner, TurnsAwayFromAWallThatItHasComeTooNearTo) {
  const double half_m = KnownVehicle{}.half_width_m;
  for (const double clearance_m : {0.24, 0.15, 0.08}) {
    const LocalPlan plan = plan_beside_a_wall(GetParam(), 3.6, half_m + clearance_m);
    EXPECT_TRUE(plan.arc.ends_free) << clearance_m;
    EXPECT_GE(plan.offset_m, 3.5) << clearance_m;
  }
}

TEST_P(EachPlanner, KeepsToAWayInWhichItCanHalt) {
  const KnownVehicle vehicle;
  std::vector<Eigen::Vector2d> across;
  add_wall(across, {10.0 + vehicle.front_m + 5.5, 12.0}, {10.0 + vehicle.front_m + 5.5, 36.0});
  const LocalPlan plan = plan_beside_a_wall(GetParam(), 14.0, 1.8, across);
  EXPECT_FALSE(plan.arc.ends_free);
  EXPECT_GE(plan.arc.free_m, 5.0 * 5.0 / (2.0 * vehicle.max_deceleration_m_s2));
}

// 2026-11-26: where no way kept its clearance for as long as it takes to halt, all were as good as that one which
// leads along the lane: seed 38 of `high` braked into a pole that it could have braked beside.
TEST_P(EachPlanner, BrakesAlongTheWayThatTouchesLast) {
  const Path route({{0.0, 0.0}, {100.0, 0.0}}, 6.5);
  const KnownVehicle vehicle;
  const MovingBody body{{{10.0, 0.0}, 0.0}, 5.0, 0.0};
  const double poles_m = 10.0 + vehicle.front_m + 3.5, side_m = vehicle.half_width_m;
  ASSERT_GT(halting_way_m(body, vehicle), 3.5);
  for (const double sign : {-1.0, 1.0}) {
    // 0.23 m of air on either side of a body in the middle between them, 0.18 m beside the lane's.
    std::vector<Eigen::Vector2d> cells{{poles_m, -sign * (side_m + 0.05)}, {poles_m, sign * (side_m + 0.41)}};
    add_wall(cells, {poles_m, -sign * (side_m + 0.05)}, {poles_m, -sign * 14.0});
    add_wall(cells, {poles_m, sign * (side_m + 0.41)}, {poles_m, sign * 14.0});
    const LocalPlan plan = default_planner(GetParam())
                               ->plan({route, 10.0, Eigen::Vector2d::Zero(), 0.0, body,
                                       BlockedCells({10.0, 0.0}, cells), *default_tracker("pure_pursuit"), vehicle});
    EXPECT_FALSE(plan.arc.ends_free);
    EXPECT_LT(plan.arc.free_m, 3.5);
    EXPECT_GE(plan.arc.untouched_m, halting_way_m(body, vehicle)) << sign;
  }
}

INSTANTIATE_TEST_SUITE_P(LocalPlanners, EachPlanner, ::testing::Values("offsets", "hybrid_a_star"),
                         [](const auto& which) { return std::string(which.param); });

}  // namespace
}  // namespace canyon::mission
