// With the true pose the reference autonomy has no excuse.
#include "canyon/tests/mission/random_missions.h"

namespace canyon::mission::testing {
namespace {

/// Drives them among whatever may stand in the lane; what was drawn for them.
std::set<std::string> all_succeed(std::uint64_t from, std::uint64_t to, const char* planner) {
  std::set<std::string> drawn;
  for (std::uint64_t number = from; number < to; ++number) {
    const RandomMission mission(number, planner, Standing::kAll);
    drawn.insert(mission.drawn().begin(), mission.drawn().end());
    EXPECT_EQ(drive_random(mission), "success") << number << " " << planner;
  }
  return drawn;
}

TEST(RandomMissions, OnTruthAHandfulSucceed) {
  all_succeed(1, 4, "offsets");
  all_succeed(4, 6, "hybrid_a_star");
}

TEST(RandomMissionsNightly, OnTruthTwoHundredSucceed) {
  EXPECT_EQ(all_succeed(1, 201, "offsets"), whatever_stands());
}

TEST(RandomMissionsNightly, OnTruthTwoHundredSucceedByASearch) {
  EXPECT_EQ(all_succeed(1, 201, "hybrid_a_star"), whatever_stands());
}

// 2026-11-23: it drove into the car before it. Standing so near, its lowest beam passes over the boot.
TEST(RandomMissions, StandingBehindAParkedCarItBacksUp) {
  for (const double ahead_m : {5.0, 6.2, 8.0}) {
    MissionConfig config = short_config(
        "low", "low", "[time]\nlimit_s = 25.0\n[run]\ntruth_as_pose = true\n[autonomy]\nmodel = \"reference\"");
    scene::MovingConfig car;
    const Eigen::Vector2d p = config.vehicle.start_m + Eigen::Vector2d(0.0, ahead_m);  // it starts headed north
    car.path_m = {p.x(), p.y(), p.x(), p.y() + 1.0};
    car.start_s = 1e5;
    config.scene.moving = {car};
    const RecordedRun run = drive(config);
    EXPECT_EQ(run.outcome, Outcome::kStopped) << ahead_m << ": " << (run.failure ? run.failure->detail : "");
    EXPECT_GT(run.nav.back().X_WB_true.p.y(), p.y() + 10.0) << ahead_m << ": past it";
  }
}

}  // namespace
}  // namespace canyon::mission::testing
