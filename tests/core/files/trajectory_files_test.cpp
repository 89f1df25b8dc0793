#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/random/random.h"
#include "canyon/tests/support/temporary_folder.h"
#include "canyon/tests/support/test_data.h"

namespace canyon {
namespace {

using testing::TemporaryFolder;

const GpsTime kStart = GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0);

Trajectory example() {
  const RandomStream random(1, "test.trajectory");
  Trajectory trajectory;
  for (std::int64_t k = 0; k < 50; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    trajectory.append({tick(kStart, k, 3.0), {so3_exp(random.normal3(i)), 1e3 * random.normal3(i, 1)}});
  }
  return trajectory;
}

void expect_same_bits(const Trajectory& a, const Trajectory& b) {
  ASSERT_EQ(a.poses().size(), b.poses().size());
  for (std::size_t i = 0; i < a.poses().size(); ++i) {
    EXPECT_EQ(a.poses()[i].t, b.poses()[i].t) << i;
    EXPECT_EQ(a.poses()[i].X_WB.p, b.poses()[i].X_WB.p) << i;
    EXPECT_EQ(a.poses()[i].X_WB.R.coeffs(), b.poses()[i].X_WB.R.coeffs()) << i;
  }
}

TEST(TrajectoryFiles, TumRoundTripIsExactTimesIncluded) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_tum(folder.file("t.txt"), example()).ok());
  const auto back = read_tum(folder.file("t.txt"));
  ASSERT_TRUE(back.ok()) << back.error().str();
  expect_same_bits(*back, example());
}

TEST(TrajectoryFiles, CsvOfOthersIsReadToTheBitTimesIncluded) {
  const TemporaryFolder folder;
  std::string text = "gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n";
  const Trajectory poses = example();
  for (const StampedPose& pose : poses.poses()) {
    const Eigen::Vector3d& p = pose.X_WB.p;
    const Eigen::Quaterniond& q = pose.X_WB.R;
    const auto sow_ns = static_cast<long long>(pose.t.sow_ns());
    text += printed("%d,%lld.%09lld,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", pose.t.week(), sow_ns / 1000000000,
                    sow_ns % 1000000000, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
  ASSERT_TRUE(write_text_file(folder.file("t.csv"), text).ok());
  const auto back = read_csv_trajectory(folder.file("t.csv"));
  ASSERT_TRUE(back.ok()) << back.error().str();
  expect_same_bits(*back, example());
}

// A rotation goes to a matrix and back, so a few roundings remain.
TEST(TrajectoryFiles, KittiOfOthers) {
  const TemporaryFolder folder;
  std::string text;
  const Trajectory poses = example();
  for (const StampedPose& pose : poses.poses()) {
    const Eigen::Matrix4d X = pose.X_WB.matrix();
    for (int i = 0; i < 12; ++i) text += printed("%.17g%c", X(i / 4, i % 4), i < 11 ? ' ' : '\n');
  }
  ASSERT_TRUE(write_text_file(folder.file("t.txt"), text).ok());
  const auto back = read_kitti(folder.file("t.txt"), kStart, 3.0);
  ASSERT_TRUE(back.ok()) << back.error().str();
  ASSERT_EQ(back->poses().size(), example().poses().size());
  for (std::size_t i = 0; i < back->poses().size(); ++i) {
    const StampedPose a = example().poses()[i], b = back->poses()[i];
    EXPECT_EQ(a.t, b.t);
    EXPECT_EQ(a.X_WB.p, b.X_WB.p);
    EXPECT_LT((a.X_WB.matrix() - b.X_WB.matrix()).cwiseAbs().maxCoeff(), 16 * 2.3e-16);
  }
}

TEST(TrajectoryFiles, WhatATumFileLooksLike) {
  const TemporaryFolder folder;
  Trajectory one;
  one.append({GpsTime::from_week_sow(1590, 0.25), {Eigen::Quaterniond(0, 0, 0, 1), {1.5, -2, 0.1}}});
  ASSERT_TRUE(write_tum(folder.file("t"), one).ok());
  EXPECT_EQ(
      *read_text_file(folder.file("t")),
      "# t_s x_m y_m z_m qx qy qz qw; t in GPS seconds since 1980-01-06\n961632000.250000000 1.5 -2 0.1 0 0 1 0\n");
}

TEST(TrajectoryFiles, TumOfOthers) {
  const TemporaryFolder folder;
  const std::string file = folder.file("t");
  // Comments, empty lines, carriage returns, tabs, an exponent, a quaternion of four digits.
  ASSERT_TRUE(write_text_file(file,
                              "# comment\r\n\r\n1.5e0 1 2 3 0 0 0 1\r\n2.0000000004\t4 5 6 0.7071 0 0 0.7071 "
                              "\n1305031102.1753 0 0 0 0 0 0 -1")
                  .ok());
  const auto t = read_tum(file);
  ASSERT_TRUE(t.ok()) << t.error().str();
  ASSERT_EQ(t->poses().size(), 3u);
  EXPECT_EQ(t->poses()[0].t.ns, 1'500'000'000);
  EXPECT_EQ(t->poses()[1].t.ns, 2'000'000'000);
  EXPECT_EQ(t->poses()[2].t.ns, 1305031102175300000);
  EXPECT_NEAR(t->poses()[1].X_WB.R.norm(), 1.0, 4.5e-16);
  EXPECT_NEAR(t->poses()[1].X_WB.R.x(), std::sqrt(0.5), 4.5e-16);
}

TEST(TrajectoryFiles, TrueMotionOfAMission) {
  const TemporaryFolder folder;
  const std::string file = folder.file("c");
  ASSERT_TRUE(write_text_file(file,
                              "t_s,gps_week,sow,true_x_m,true_y_m,true_z_m,true_yaw_deg,true_pitch_deg,true_roll_deg,"
                              "est_x_m\n0.1,1590,5.1,1,2,3,90,0,0,1.5\n")
                  .ok());
  const auto t = read_csv_trajectory(file);
  ASSERT_TRUE(t.ok()) << t.error().str();
  EXPECT_EQ(t->poses()[0].t.sow_ns(), 5'100'000'000);
  EXPECT_EQ(t->poses()[0].X_WB.p, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_LT((t->poses()[0].X_WB.R * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 4 * 2.3e-16);
}

TEST(TrajectoryFiles, CsvColumnsAreFoundByName) {
  const TemporaryFolder folder;
  const std::string file = folder.file("c");
  ASSERT_TRUE(
      write_text_file(file, "qz,qy,qx,qw, sow ,gps_week,note,z_m,y_m,x_m\n0,0,0,1,5.5,2000,\"hello\",3,2,1\n").ok());
  const auto t = read_csv_trajectory(file);
  ASSERT_TRUE(t.ok()) << t.error().str();
  EXPECT_EQ(t->poses()[0].t, GpsTime::from_week_sow(2000, 5.5));
  EXPECT_EQ(t->poses()[0].X_WB.p, Eigen::Vector3d(1, 2, 3));
}

struct BadFile {
  const char* text;
  const char* message;  ///< after the file's name
};

void expect_errors(const std::vector<BadFile>& rows,
                   const std::function<Result<Trajectory>(const std::string&)>& read) {
  const TemporaryFolder folder;
  const std::string file = folder.file("bad");
  for (const BadFile& row : rows) {
    ASSERT_TRUE(write_text_file(file, row.text).ok());
    const auto result = read(file);
    ASSERT_FALSE(result.ok()) << row.text;
    EXPECT_EQ(result.error().str(), file + row.message);
  }
  EXPECT_FALSE(read(folder.file("missing")).ok());
}

TEST(TrajectoryFiles, BadTumWordForWord) {
  expect_errors(
      {{"", ": holds no poses, expected at least one line of numbers"},
       {"1 2 3\n", ":1: 3 columns, expected 8: t x y z qx qy qz qw"},
       {"#\n1 2 x 3 0 0 0 1\n", ":2: \"x\" is not a finite number, expected a number"},
       {"1 2 nan 3 0 0 0 1\n", ":1: \"nan\" is not a finite number, expected a number"},
       {"1 2 3 3 0 0 0 0\n", ":1: quaternion of norm 0.000000, expected norm 1"},
       {"1e300 2 3 3 0 0 0 1\n", ":1: \"1e300\" is not a time, expected seconds since the GPS epoch"},
       {"1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ":2: time does not increase, expected poses in the order of time"}},
      read_tum);
}

TEST(TrajectoryFiles, BadKittiWordForWord) {
  expect_errors(
      {{"1 0 0\n", ":1: 3 columns, expected 12: a 3 x 4 matrix, row by row"},
       {"1 0 0 0 0 1 0 0 0 0 -1 0\n", ":1: first three columns are not a rotation, expected orthonormal axes"},
       {"2 0 0 0 0 1 0 0 0 0 1 0\n", ":1: first three columns are not a rotation, expected orthonormal axes"}},
      [](const std::string& path) { return read_kitti(path, kStart, 10.0); });
}

TEST(TrajectoryFiles, BadCsvWordForWord) {
  const char* header = "gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n";
  expect_errors({{"gps_week,sow,x_m,y_m,z_m,qw,qx,qy\n",
                  ":1: no column \"qz\", expected the header gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz"},
                 {header, ": holds no poses, expected at least one line of numbers"},
                 {"gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n1590,1,2,3\n", ":2: 4 columns, expected 9 as in the header"},
                 {"gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n1590.5,1,2,3,4,1,0,0,0\n",
                  ":2: \"1590.5\" is not a GPS week, expected a whole number from 0 to 14000"},
                 {"gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n1590,,2,3,4,1,0,0,0\n",
                  ":2: \"\" is not a finite number, expected a number"}},
                read_csv_trajectory);
}

// Real poses of an Ouster drive, as its maker's tool writes them.
TEST(TrajectoryFiles, RealKittiPosesAreRead) {
  CANYON_REAL_DATA(path, "lidar/ouster/OS-1-128_v2.3.0_1024x10_lb_n3_poses_kitti.txt");
  const auto t = read_kitti(path, kStart, 10.0);
  ASSERT_TRUE(t.ok()) << t.error().str();
  EXPECT_EQ(t->poses().size(), 3u);
  for (const StampedPose& pose : t->poses()) EXPECT_NEAR(pose.X_WB.R.norm(), 1.0, 4.5e-16);
}

// 2026-11-22: 1e308 m went through to a failed check of the true motion.
TEST(TrajectoryFiles, PlacesAndTimesHaveLimits) {
  expect_errors({{"0 0 1e308 0 0 0 0 1\n", ":1: \"1e308\" is out of range, expected metres from -1e9 to 1e9"},
                 {"0 0 0 -1.1e9 0 0 0 1\n", ":1: \"-1.1e9\" is out of range, expected metres from -1e9 to 1e9"},
                 {"0 0 0 0 0 0 0 1e200\n", ":1: quaternion of norm 1e9 or more, expected norm 1"},
                 {"-9e9 0 0 0 0 0 0 1\n9e9 0 0 0 0 0 0 1\n",
                  ":2: more than 292 years after the first line, expected poses in the order of time"}},
                [](const std::string& file) { return read_tum(file); });
  expect_errors({{"gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n14000,9e9,0,0,0,1,0,0,0\n",
                  ":2: a time beyond the year 2272, expected a GPS week from 0 to 14000 and the seconds of it"},
                 {"gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n1,0,0,0,2e9,1,0,0,0\n",
                  ":2: \"2e9\" is out of range, expected metres from -1e9 "
                  "to 1e9"}},
                read_csv_trajectory);
  expect_errors(
      {{"1 0 0 1e9 0 1 0 -1e10 0 0 1 0\n", ":1: \"-1e10\" is out of range, expected metres from -1e9 to 1e9"},
       {"1e200 0 0 0 0 1e200 0 0 0 0 1 0\n", ":1: first three columns are not a rotation, expected orthonormal axes"}},
      [](const std::string& file) { return read_kitti(file, GpsTime{}, 10.0); });
}

}  // namespace
}  // namespace canyon
