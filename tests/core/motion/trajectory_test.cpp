#include "canyon/core/motion/trajectory.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "canyon/core/check.h"

namespace canyon {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
const GpsTime kTrackStart = GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0);

/// On a circle of 20 m, 0.1 rad a second.
StampedPose on_circle(double t_s) {
  const double a = 0.1 * t_s;
  return {kTrackStart + t_s, {rotation_from({a, 0, 0}), {20 * std::sin(a), 20 * (1 - std::cos(a)), 0}}};
}

Trajectory circle() {
  Trajectory trajectory;
  for (int k = 0; k <= 10; ++k) trajectory.append(on_circle(k));
  return trajectory;
}

TEST(Trajectory, InterpolatesOnTheGeodesic) {
  const Trajectory trajectory = circle();
  for (double t_s = 0.0; t_s <= 10.0; t_s += 0.125) {
    const auto X = trajectory.at(kTrackStart + t_s);
    ASSERT_TRUE(X.has_value()) << t_s;
    EXPECT_LT((X->p - on_circle(t_s).X_WB.p).norm(), 128 * kEps * 20) << t_s;
    EXPECT_LT(X->R.angularDistance(on_circle(t_s).X_WB.R), 64 * kEps) << t_s;
  }
}

TEST(Trajectory, StoredPosesComeBackToTheBit) {
  const Trajectory trajectory = circle();
  for (const StampedPose& pose : trajectory.poses()) EXPECT_EQ(trajectory.at(pose.t)->matrix(), pose.X_WB.matrix());
}

TEST(Trajectory, OutsideThereIsNoPose) {
  const Trajectory trajectory = circle();
  EXPECT_FALSE(trajectory.at(kTrackStart - 1e-9).has_value());
  EXPECT_FALSE(trajectory.at(kTrackStart + 10.000000001).has_value());
  EXPECT_FALSE(Trajectory().at(kTrackStart).has_value());
  EXPECT_TRUE(Trajectory().empty());
}

TEST(Trajectory, ForgettingKeepsThePoseBefore) {
  Trajectory trajectory = circle();
  const auto before = trajectory.at(kTrackStart + 4.5);
  trajectory.forget_before(kTrackStart + 4.5);
  EXPECT_EQ(trajectory.poses().front().t, kTrackStart + 4.0);
  EXPECT_EQ(trajectory.at(kTrackStart + 4.5)->matrix(), before->matrix());
  trajectory.forget_before(kTrackStart + 6.0);
  EXPECT_EQ(trajectory.poses().front().t, kTrackStart + 6.0);
  trajectory.forget_before(kTrackStart);  // nothing left to forget
  EXPECT_EQ(trajectory.poses().size(), 5u);
  trajectory.forget_before(kTrackStart + 100.0);
  EXPECT_EQ(trajectory.poses().size(), 1u);
  Trajectory none;
  none.forget_before(kTrackStart);
  EXPECT_TRUE(none.empty());
}

TEST(Trajectory, TimesMustIncrease) {
  Trajectory trajectory = circle();
  EXPECT_THROW(trajectory.append(on_circle(10)), ProgramError);
  EXPECT_THROW(trajectory.append(on_circle(3)), ProgramError);
  EXPECT_THROW(Trajectory({on_circle(1), on_circle(1)}), ProgramError);
}

}  // namespace
}  // namespace canyon
