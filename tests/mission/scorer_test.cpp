#include "mission/scorer.h"

#include "mission/facade.h"
#include "tests/mission/short_mission.h"

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
  EXPECT_EQ(scorer_.outcome(), "success") << (scorer_.failure() ? scorer_.failure()->detail : "");
  EXPECT_TRUE(scorer_.waypoints()[0].reached);
  EXPECT_NEAR(scorer_.waypoints()[1].stopped_s, 5.5, 1e-9);
}

TEST_F(ScorerTest, AStopTooFarAwayIsAMissedWaypoint) {
  for (int i = 0; i < 20; ++i) step({213.9, 146.0}, 0.0, true);
  scorer_.finish(at({213.9, 146.0}, t_s_), true);
  EXPECT_EQ(scorer_.outcome(), "missed_waypoint");
  EXPECT_EQ(scorer_.failure()->detail, "house: came within 4.0 m, stood there for 0.0 s");
}

TEST_F(ScorerTest, AStopTooShortIsAMissedWaypoint) {
  for (int i = 0; i < 8; ++i) step({213.9, 150.0}, 0.0, true);
  scorer_.finish(at({213.9, 150.0}, t_s_), true);
  EXPECT_EQ(scorer_.outcome(), "missed_waypoint");
}

TEST_F(ScorerTest, DrivingIntoAHouseIsACollisionWithItsName) {
  bool ended = false;
  for (double x = 213.9; x < 245 && !ended; x += 0.3) ended = !step({x, 150.0}, 3.0);
  EXPECT_TRUE(ended);
  EXPECT_EQ(scorer_.outcome(), "collision");
  EXPECT_EQ(scorer_.failure()->detail.substr(0, 4), "hit ");
}

TEST_F(ScorerTest, StandingStillWithoutReasonIsStuck) {
  bool go_on = true;
  for (int i = 0; i < 400 && go_on; ++i) go_on = step({213.9, 60.0}, 0.0);
  EXPECT_FALSE(go_on);
  EXPECT_EQ(scorer_.outcome(), "stuck");
  EXPECT_NEAR(scorer_.failure()->t_s, config_.success.stuck_after_s, 1.0);
}

TEST_F(ScorerTest, NotBeingDoneIsATimeout) {
  step({213.9, 60.0}, 5.0);
  scorer_.finish(at({213.9, 60.0}, t_s_), false);
  EXPECT_EQ(scorer_.outcome(), "timeout");
}

TEST(Facade, IsTheWallThatFacesTheViewer) {
  scene::Building building;
  building.footprint_W = {{0, 0}, {10, 0}, {10, 20}, {0, 20}};
  building.base_m = 5;
  building.height_m = 10;
  const auto points = facade_points(building, {30, 10});
  ASSERT_EQ(points.size(), 25U);
  for (const auto& p : points) {
    EXPECT_NEAR(p.x(), 10.05, 1e-12);
    EXPECT_GT(p.y(), 0);
    EXPECT_LT(p.y(), 20);
    EXPECT_GT(p.z(), 5);
    EXPECT_LT(p.z(), 15);
  }
  EXPECT_TRUE(facade_points(building, {5, 10}).empty());  // from inside
}

}  // namespace
}  // namespace canyon::mission::testing
