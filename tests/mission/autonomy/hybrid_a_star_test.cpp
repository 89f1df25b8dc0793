#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/mission/autonomy/planning/search/free_ways.h"
#include "canyon/tests/mission/autonomy/planning_parts.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using testing::add_wall;
using testing::default_planner;

const KnownVehicle kAsBuilt;

const Tracker& pursuit() {
  static const auto kept = testing::default_tracker("pure_pursuit");
  return *kept;
}

/// How far a body comes along a straight lane at 2 m/s when a planner plans anew every quarter of a metre, and its
/// least clearance on the way; it stays where its plan has less than a metre left, at most 45 m.
struct Driven {
  double along_m = 0.0, clearance_m = 1e3, beside_m = 0.0;
};
Driven drive_by(LocalPlanner& by, const std::vector<Vector2d>& cells) {
  const Path route({{0.0, 0.0}, {200.0, 0.0}}, 6.5);
  const BlockedCells blocked({20.0, 0.0}, cells);
  MovingBody body{{{5.0, 0.0}, 0.0}, 2.0, 0.0};
  Driven out;
  while (body.pose.p_m.x() < 45.0) {
    const LocalPlan plan =
        by.plan({route, body.pose.p_m.x(), Vector2d::Zero(), 0.0, body, blocked, pursuit(), kAsBuilt});
    if (!plan.arc.ends_free && plan.arc.free_m < 1.0) break;
    std::size_t nearest = 0;
    for (int i = 0; i < 5; ++i) {
      nearest = plan.line.nearest(body.pose.p_m, nearest);
      const double kappa = pursuit().curvature_1_m(plan.line, nearest, body.pose, body.speed_m_s);
      body.steering_rad = steered_rad(body.steering_rad, kappa, 0.05 / body.speed_m_s, kAsBuilt);
      body.pose = body.pose.along(std::tan(body.steering_rad) / kAsBuilt.wheelbase_m, 0.05);
      out.clearance_m = std::min(out.clearance_m, blocked.clearance_m(body.pose, kAsBuilt, 5.0));
    }
  }
  out.along_m = body.pose.p_m.x();
  out.beside_m = body.pose.p_m.y();
  return out;
}

// A wall from the right and, 5 m on, one from the left: a line to one offset sees the second too late.
TEST(HybridAStar, DrivesAChicaneThatNoOffsetDoes) {
  std::vector<Vector2d> chicane;
  add_wall(chicane, {18.0, -9.0}, {18.0, 1.5});
  add_wall(chicane, {23.0, -1.5}, {23.0, 9.0});
  const Driven searched = drive_by(*default_planner("hybrid_a_star"), chicane);
  EXPECT_GE(searched.along_m, 45.0);
  EXPECT_GT(searched.clearance_m, 0.2);  // 0.3, less what steps of 5 cm and a tracker make of it
  EXPECT_LT(std::abs(searched.beside_m), 0.5);
  EXPECT_LT(drive_by(*default_planner("offsets"), chicane).along_m, 23.0);
}

TEST(HybridAStar, KeepsToAFreeLane) {
  const Driven free = drive_by(*default_planner("hybrid_a_star"), {});
  EXPECT_GE(free.along_m, 45.0);
  EXPECT_NEAR(free.beside_m, 0.0, 1e-9);
}

TEST(HybridAStar, HaltsBeforeAClosedStreet) {
  std::vector<Vector2d> wall;
  add_wall(wall, {24.0, -12.0}, {24.0, 12.0});
  const Driven halted = drive_by(*default_planner("hybrid_a_star"), wall);
  EXPECT_LT(halted.along_m + kAsBuilt.front_m, 24.0 - 0.3 + 1e-9);
  EXPECT_GT(halted.along_m + kAsBuilt.front_m, 24.0 - 3.5);
  EXPECT_GE(halted.clearance_m, 0.3 - 1e-9);
}

// The same task twice, and the same planner made anew.
TEST(HybridAStar, PlansTheSameAgain) {
  std::vector<Vector2d> cells;
  const RandomStream draws(3, "test.hybrid_a_star");
  for (int i = 0; i < 60; ++i) cells.emplace_back(draws.uniform(12, 30, 0, i), draws.uniform(-6, 6, 1, i));
  const BlockedCells blocked({10.0, 0.0}, cells);
  const Path route({{0.0, 0.0}, {60.0, 0.0}}, 6.5);
  const PlanTask task{route, 5.0, Vector2d::Zero(), 0.2, {{{5.0, 0.5}, 0.1}, 3.0, 0.0}, blocked, pursuit(), kAsBuilt};
  const LocalPlan one = default_planner("hybrid_a_star")->plan(task),
                  other = default_planner("hybrid_a_star")->plan(task);
  ASSERT_EQ(one.line.points_O.size(), other.line.points_O.size());
  for (std::size_t i = 0; i < one.line.points_O.size(); ++i) EXPECT_EQ(one.line.points_O[i], other.line.points_O[i]);
}

// Between posts at random: where a line to an offset is free, a search finds a free way too, nearly always, and both
// are driven without coming nearer than they may.
TEST(HybridAStar, FindsAWayWhereOffsetsDo) {
  const RandomStream draws(4, "test.hybrid_a_star");
  const Path route({{0.0, 0.0}, {60.0, 0.0}}, 6.5);
  int by_offsets = 0, by_both = 0, by_search = 0;
  for (int k = 0; k < 200; ++k) {
    std::vector<Vector2d> cells;
    for (int i = 0; i < 8; ++i) {
      const Vector2d post(draws.uniform(12, 28, 0, 8 * k + i), draws.uniform(-5, 5, 1, 8 * k + i));
      add_wall(cells, post - Vector2d(0.0, 0.5), post + Vector2d(0.0, 0.5));
    }
    const BlockedCells blocked({10.0, 0.0}, cells);
    const MovingBody body{{{5.0, draws.uniform(-1, 1, 2, k)}, draws.uniform(-0.1, 0.1, 3, k)}, 2.0, 0.0};
    const PlanTask task{route, 5.0, Vector2d::Zero(), 0.0, body, blocked, pursuit(), kAsBuilt};
    const bool offset = default_planner("offsets")->plan(task).arc.ends_free;
    const bool searched = default_planner("hybrid_a_star")->plan(task).arc.ends_free;
    by_offsets += offset ? 1 : 0;
    by_search += searched ? 1 : 0;
    by_both += offset && searched ? 1 : 0;
  }
  // 93 of 95, and 185.
  EXPECT_GE(by_both, 0.95 * by_offsets) << by_offsets;
  EXPECT_GE(by_search, 1.5 * by_offsets) << by_offsets;
}

/// Costs of a place: its distance from the lane's middle.
double beside(const LanePlaces::Place& at) {
  return std::abs(at.beside_m);
}

// By every way of a point through the grid, one cell after another.
TEST(FreeWays, AreTheCheapestOfAll) {
  std::vector<Vector2d> cells;
  add_wall(cells, {9.0, -2.5}, {9.0, 0.6});
  const BlockedCells blocked({5.0, 0.0}, cells);
  const Path route({{0.0, 0.0}, {60.0, 0.0}}, 6.5);
  const PlanTask task{route, 6.0, Vector2d::Zero(), 0.0, {}, blocked, pursuit(), kAsBuilt};
  PlanParameters p;
  p.horizon_m = 5.0;
  const FreeWays ways(task, p, {-1.5, 2.5}, beside);
  const auto open = [&](double x, double y) {
    double nearest = 1e3;
    for (const Vector2d& c : cells) nearest = std::min(nearest, (c - Vector2d(x, y)).norm());
    return nearest >= 0.75 + 0.3 - 0.25;
  };
  const std::function<double(int, int)> cheapest = [&](int i, int j) {
    double best = p.blocked_cost_1_m * (5.0 - 0.5 * i) + 5.0 * std::abs(-1.5 + 0.5 * j);
    for (int to = std::max(0, j - 2); to <= std::min(8, j + 2) && i < 10; ++to) {
      const double y = -1.5 + 0.5 * j, next_y = -1.5 + 0.5 * to;
      if (open(6.5 + 0.5 * i, next_y))
        best = std::min(best, 0.25 * (std::abs(y) + std::abs(next_y)) + cheapest(i + 1, to));
    }
    return best;
  };
  for (const int i : {0, 3, 4, 6, 9})
    for (int j = 0; j <= 8; ++j)
      EXPECT_NEAR(ways.cost({6.0 + 0.5 * i, -1.5 + 0.5 * j}), cheapest(i, j), 1e-12) << i << " " << j;
}

// Round a bend, and beyond the end.
TEST(LanePlaces, ThereAndBack) {
  const Path route({{0.0, 0.0}, {20.0, 0.0}, {20.0, 15.0}}, 6.5);
  const PlanTask task{route, 0.0, {3.0, -2.0}, 0.4, {}, BlockedCells{}, pursuit(), kAsBuilt};
  const LanePlaces lane(task);
  for (double s = 1.0; s < route.length_m() + 8.0; s += 0.7)
    for (const double beside_m : {-2.0, 0.0, 1.5}) {
      const LanePlaces::Place back = lane.of(lane.at({s, beside_m}), s - 1.5, s + 3.0);
      EXPECT_NEAR(back.s_m, s, 0.15) << beside_m;  // the bend is a polyline
      EXPECT_NEAR(back.beside_m, beside_m, 0.02) << s;
    }
}

}  // namespace
}  // namespace canyon::mission
