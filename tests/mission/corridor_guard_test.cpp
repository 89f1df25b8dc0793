#include "canyon/mission/corridor_guard.h"

#include <gtest/gtest.h>

namespace canyon::mission {
namespace {

constexpr double kUntil_s = 100.0;

Pose level_at(double x, double y, double z) {
  return {Eigen::Quaterniond::Identity(), {x, y, z}};
}

/// Two pieces along x, 10 m each and 2 m to either side; only the first leaves out occlusion.
std::vector<PlannedPlace> corridor() {
  std::vector<PlannedPlace> places(2);
  for (int i = 0; i < 2; ++i) {
    RouteSegment& segment = places[static_cast<std::size_t>(i)].segment;
    segment.points_W = {{10.0 * i, 0, 0}, {10.0 * (i + 1), 0, 0}};
    segment.half_width_m = 2.0;
    segment.low_m = -0.5;
    segment.high_m = 0.5;
  }
  places[0].paths.occlusion = true;
  places[1].paths.foliage = true;
  return places;
}

TEST(CorridorGuard, LeavesOutWhatThePieceAllows) {
  CorridorGuard guard(corridor(), kUntil_s);
  EXPECT_TRUE(guard.at(1.0, level_at(5, 1.9, 0)).occlusion);
  EXPECT_FALSE(guard.at(2.0, level_at(15, -1.9, 0)).occlusion);
  EXPECT_TRUE(guard.at(2.0, level_at(15, -1.9, 0)).foliage);
  EXPECT_FALSE(guard.left());
}

TEST(CorridorGuard, BesideTheCorridorEverythingComesBackForGoodAndItIsSaidWhen) {
  Pose tilted = level_at(5, 0, 0);
  tilted.R = so3_exp({0.46, 0, 0});
  for (const Pose& beside : {level_at(5, 2.1, 0), level_at(5, 0, 0.6), level_at(-2.1, 0, 0), tilted}) {
    CorridorGuard guard(corridor(), kUntil_s);
    EXPECT_TRUE(guard.at(1.0, level_at(5, 0, 0)).occlusion);
    EXPECT_EQ(guard.at(12.5, beside), gnss::PathOmissions{});
    EXPECT_EQ(guard.at(13.0, level_at(5, 0, 0)), gnss::PathOmissions{}) << "what follows from having been beside it";
    ASSERT_TRUE(guard.left());
    EXPECT_EQ(guard.left()->rfind("left the plan's corridor at 12.50 s, x ", 0), 0U) << *guard.left();
  }
}

// The sky has been looked at up to the time limit; a tape may go on.
TEST(CorridorGuard, BeyondItsTimeNothingIsLeftOut) {
  CorridorGuard guard(corridor(), kUntil_s);
  EXPECT_TRUE(guard.at(100.0, level_at(5, 0, 0)).occlusion);
  EXPECT_EQ(guard.at(100.1, level_at(5, 0, 0)), gnss::PathOmissions{});
  ASSERT_TRUE(guard.left());
  EXPECT_EQ(guard.left()->rfind("drives beyond the plan's time limit at 100.10 s, x ", 0), 0U) << *guard.left();
}

TEST(CorridorGuard, WithoutACorridorNothingIsLeftOut) {
  CorridorGuard guard({}, kUntil_s);
  EXPECT_EQ(guard.at(0.0, level_at(0, 0, 0)), gnss::PathOmissions{});
  EXPECT_FALSE(guard.left());
}

}  // namespace
}  // namespace canyon::mission
