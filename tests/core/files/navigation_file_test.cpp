#include "canyon/core/files/navigation_file.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/tests/support/temporary_folder.h"
#include "canyon/tests/support/test_data.h"

namespace canyon {
namespace {

std::string temporary(const std::string& name, const std::string& text) {
  const std::string path = testing::temporary_file(name);
  std::ofstream(path) << text;
  return path;
}

TEST(NedAttitude, IsThatOfForwardRightDown) {
  const Geodetic at{0.5, -1.0, 100.0};
  const Eigen::Matrix3d enu = rotation_E_from_enu(at);
  // Heading east, level: forward east, left north, up up.
  const Eigen::Matrix3d east = attitude_from_ned(at, 0.0, 0.0, 0.5 * kPi).toRotationMatrix();
  EXPECT_LT((east - enu).norm(), 1e-15);
  // Nose up: forward gains height.
  EXPECT_NEAR((attitude_from_ned(at, 0.0, 0.1, 0.3) * Eigen::Vector3d::UnitX()).dot(enu.col(2)), std::sin(0.1), 1e-15);
  // Right side down: left gains height.
  EXPECT_NEAR((attitude_from_ned(at, 0.1, 0.0, 0.3) * Eigen::Vector3d::UnitY()).dot(enu.col(2)), std::sin(0.1), 1e-15);
}

TEST(NedAttitude, ComesBackEverywhere) {
  for (const double lat_deg : {-90.0, -33.0, 0.0, 89.9, 90.0}) {
    const Geodetic at{lat_deg * kDegree, 2.0, 0.0};
    for (const double heading : {0.0, 1.0, 3.2, 6.2}) {
      const NedAttitude a = ned_attitude(at, attitude_from_ned(at, -0.4, 1.2, heading));
      EXPECT_NEAR(a.roll_rad, -0.4, 1e-14);  // a few eps over cos(pitch)
      EXPECT_NEAR(a.pitch_rad, 1.2, 1e-14);
      EXPECT_NEAR(std::remainder(a.heading_rad - heading, 2.0 * kPi), 0.0, 1e-14);
      EXPECT_GE(a.heading_rad, 0.0);
      EXPECT_LT(a.heading_rad, 2.0 * kPi);
    }
  }
}

TEST(NavigationFile, ReadsWhatItWrites) {
  NavigationFile file;
  file.gravity = "wgs84";
  for (int i = 0; i < 3; ++i) {
    const Geodetic at{(i - 1) * 1.2, 0.7 * i, 50.0 * i};
    file.records.push_back({GpsTime::from_week_sow(1590, 604799.5 + 0.25 * i),
                            {attitude_from_ned(at, 0.1 * i, -0.2, 3.0), ecef_from_geodetic(at)},
                            {1.0 * i, -2.0, 3.0}});
  }
  const std::string path = temporary("round.nav", "");
  ASSERT_TRUE(write_navigation_file(path, file));
  const auto back = read_navigation_file(path);
  ASSERT_TRUE(back) << back.error().str();
  EXPECT_EQ(back->gravity, "wgs84");
  ASSERT_EQ(back->records.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back->records[i].t, file.records[i].t);
    EXPECT_LT((back->records[i].X_EU.p - file.records[i].X_EU.p).norm(), 1e-7);  // seven decimals of height
    EXPECT_LT((back->records[i].v_EU_E - file.records[i].v_EU_E).norm(), 2e-9);  // nine of velocity
    EXPECT_LT(back->records[i].X_EU.R.angularDistance(file.records[i].X_EU.R), 1e-13);
  }
}

TEST(NavigationFile, ReadsCsvByItsNames) {
  const auto file = read_navigation_file(temporary(
      "named.csv", "t_s,lat_deg,lon_deg,h_m,roll_deg,pitch_deg,yaw_deg\n1.5,30,114,20,0,0,90\n2.5,30,114,20,0,0,90\n"));
  ASSERT_TRUE(file) << file.error().str();
  EXPECT_EQ(file->gravity, "");
  EXPECT_EQ(file->records[0].t.ns, 1'500'000'000);
  EXPECT_TRUE(file->records[0].v_EU_E.hasNaN());
}

TEST(NavigationFile, NamesWhatIsWrongAndWhere) {
  const auto message = [](const std::string& text) {
    const std::string path = temporary("bad.nav", text);
    const auto file = read_navigation_file(path);
    EXPECT_FALSE(file) << text;
    return file ? "" : file.error().str();
  };
  const std::string path = testing::temporary_file("bad.nav");
  const std::string columns =
      "11 columns, week sow lat lon h vN vE vD roll pitch heading, or a header with "
      "sow,lat_deg,lon_deg,h_m,vn,ve,vd,roll_deg,pitch_deg,heading_deg";
  EXPECT_EQ(message(""), path + ": holds no navigation records, expected at least one line of numbers");
  EXPECT_EQ(message("0 1 30 114\n"), path + ":1: 4 columns, expected " + columns);
  EXPECT_EQ(message("sow,lat_deg,lon_deg,h_m,roll_deg,pitch_deg\n"),
            path + ":1: no column \"heading_deg\", expected " + columns);
  EXPECT_EQ(message("0 2 30 114 20 0 0 0 0 0 0\n0 2 30 114 20 0 0 0 0 0 0\n"),
            path + ":2: time does not increase, expected records in the order of time");
  EXPECT_EQ(message("0 2 91 114 20 0 0 0 0 0 0\n"), path + ":1: latitude 91, expected degrees from -90 to 90");
  EXPECT_EQ(message("0.5 2 1 114 20 0 0 0 0 0 0\n"),
            path + ":1: GPS week 0.5, expected a whole number from 0 to 14000");
}

TEST(NavigationFile, ReadsTheKfGinsReference) {
  CANYON_REAL_DATA(path, "inertial/kfgins_gnss_only/KF-GINS-Matlab_dataset2_truth.nav");
  const auto file = read_navigation_file(path);
  ASSERT_TRUE(file) << file.error().str();
  const NavigationRecord& first = file->records.front();
  EXPECT_EQ(first.t.sow_ns(), 116454'000'000'000);
  EXPECT_NEAR(geodetic_from_ecef(first.X_EU.p).h_m, 21.0190, 1e-9);
  EXPECT_NEAR(ned_attitude(geodetic_from_ecef(first.X_EU.p), first.X_EU.R).heading_rad / kDegree, 179.50004, 1e-12);
}

}  // namespace
}  // namespace canyon
