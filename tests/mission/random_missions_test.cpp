// With the true pose the reference autonomy has no excuse.
#include "canyon/tests/mission/random_missions.h"

namespace canyon::mission::testing {
namespace {

TEST(RandomMissions, OnTruthAHandfulSucceed) {
  for (std::uint64_t number = 1; number <= 3; ++number)
    for (const char* planner : {"offsets", "hybrid_a_star"})
      EXPECT_EQ(drive_random(number, planner), "success") << number << " " << planner;
}

TEST(RandomMissionsNightly, OnTruthTwoHundredSucceed) {
  for (std::uint64_t number = 1; number <= 200; ++number)
    EXPECT_EQ(drive_random(number, "offsets"), "success") << number;
}

TEST(RandomMissionsNightly, OnTruthTwoHundredSucceedByASearch) {
  for (std::uint64_t number = 1; number <= 200; ++number)
    EXPECT_EQ(drive_random(number, "hybrid_a_star"), "success") << number;
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
