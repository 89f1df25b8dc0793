#include "canyon/lidar/sweep_motion.h"

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

using testing::kStart;

TEST(SweepMotion, FollowsAConstantTwistWithinTheStatedChordError) {
  Vector6d twist;
  twist << 0.3, -0.5, 2.0, 15.0, 1.0, -0.5;  // rad/s, m/s in the body
  const Pose first = testing::pose_at(300, -200, 20, 60);
  const Trajectory motion = testing::twisting(first, twist);
  const Pose X_BL = testing::pose_at(0.3, 0.1, 1.8, 5);
  const SweepMotion sweep(motion, kStart, -0.1, 0.0, Pose{}, X_BL);
  const double w = twist.head<3>().norm();
  const double a = w * twist.tail<3>().norm() + w * w * X_BL.p.norm();
  const double h = 0.25e-3;
  std::size_t hint = 0;
  for (int k = 0; k <= 1000; ++k) {
    const double time_s = -0.1 + 0.0001 * k;
    const auto placed = sweep.at(time_s, hint);
    const Pose exact = first * Pose::exp(twist * time_s) * X_BL;
    // (w h)^2 / 8 in every element of R, a h^2 / 8 in position, and rounding of coordinates of 400 m in exp and
    // products.
    EXPECT_LT((placed.R - exact.R.toRotationMatrix()).cwiseAbs().maxCoeff(), w * w * h * h / 8 + 1e-14);
    EXPECT_LT((placed.p - exact.p).norm(), a * h * h / 8 + 400 * 1e-14);
  }
}

TEST(SweepMotion, AnyOrderOfTimesGivesTheSame) {
  Vector6d twist;
  twist << 0, 0, 1, 10, 0, 0;
  const SweepMotion sweep(testing::twisting(Pose{}, twist), kStart, -0.1, 0.0, Pose{}, Pose{});
  std::size_t up = 0, jumping = 0;
  for (int k = 0; k <= 100; ++k) {
    const double time_s = -0.1 + 0.001 * k;
    const auto a = sweep.at(time_s, up);
    sweep.at(-0.1 * ((k * 37) % 101) / 100.0, jumping);
    EXPECT_EQ(a.p, sweep.at(time_s, jumping).p) << time_s;
  }
}

TEST(SweepMotion, AReaderGivesTheSameBits) {
  Vector6d twist;
  twist << 0.3, -0.5, 2.0, 15.0, 1.0, -0.5;
  const SweepMotion sweep(testing::twisting(testing::pose_at(300, -200, 20, 60), twist), kStart, -0.1, 0.0, Pose{},
                          testing::pose_at(0.3, 0.1, 1.8, 5));
  SweepMotion::Reader reader(sweep);
  std::size_t hint = 0;
  const auto look = [&](double time_s) {
    const auto placed = sweep.at(time_s, hint), read = reader.at(time_s);
    EXPECT_EQ(placed.R, read.R) << time_s;
    EXPECT_EQ(placed.p, read.p) << time_s;
  };
  for (int k = 0; k <= 20000; ++k) look(-0.1 + 5e-6 * k);                // ends and nodes among them
  for (int k = 0; k <= 100; ++k) look(-0.1 * ((k * 37) % 101) / 100.0);  // to and fro
  for (const double time_s : {-0.1 - 5e-9, 5e-9}) look(time_s);          // within the tolerance
  EXPECT_THROW(reader.at(1e-6), ProgramError);
  EXPECT_THROW(reader.at(-0.101), ProgramError);

  Trajectory one;
  one.append({kStart, testing::pose_at(1, 2, 3, 4)});
  const SweepMotion standing(one, kStart, -0.1, 0.0, Pose{}, Pose{});
  SweepMotion::Reader stands(standing);
  hint = 0;
  EXPECT_EQ(stands.at(0.0).R, standing.at(0.0, hint).R);
  EXPECT_EQ(stands.at(-5e-9).p, standing.at(0.0, hint).p);
  EXPECT_THROW(stands.at(-0.05), ProgramError);
}

TEST(SweepMotion, CoversWhatTheTrajectoryCovers) {
  Trajectory motion;
  motion.append({kStart - 0.06, Pose{}});
  motion.append({kStart - 0.02, testing::pose_at(1, 0, 0, 0)});
  const SweepMotion sweep(motion, kStart, -0.1, 0.0, Pose{}, Pose{});
  EXPECT_FALSE(sweep.covers(-0.061));
  EXPECT_TRUE(sweep.covers(-0.06));
  EXPECT_TRUE(sweep.covers(-0.02));
  EXPECT_FALSE(sweep.covers(-0.019));
  std::size_t hint = 0;
  EXPECT_NEAR(sweep.at(-0.04, hint).p.x(), 0.5, 1e-9);
  EXPECT_THROW(sweep.at(0.0, hint), ProgramError);
  EXPECT_FALSE(SweepMotion(Trajectory{}, kStart, -0.1, 0.0, Pose{}, Pose{}).covers(0.0));
  // One pose alone covers its own instant.
  Trajectory one;
  one.append({kStart, testing::pose_at(2, 0, 0, 0)});
  const SweepMotion instant(one, kStart, -0.1, 0.0, Pose{}, Pose{});
  EXPECT_TRUE(instant.covers(0.0));
  EXPECT_FALSE(instant.covers(-0.01));
  EXPECT_EQ(instant.at(0.0, hint = 0).p.x(), 2.0);
  // Out of reach altogether.
  EXPECT_FALSE(SweepMotion(one, kStart + 5.0, -0.1, 0.0, Pose{}, Pose{}).covers(-0.05));
}

}  // namespace
}  // namespace canyon::lidar
