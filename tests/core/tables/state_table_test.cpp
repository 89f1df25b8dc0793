#include "canyon/core/tables/state_table.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/units.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

class StateTableTest : public ::testing::Test {
 protected:
  Result<StateTable> read(const std::string& text, const std::string& columns = {}) const {
    EXPECT_TRUE(write_text_file(path_, text).ok());
    return read_state_table(path_, columns);
  }
  std::string mistake(const std::string& text) const {
    const std::string line = read(text).error().str();
    return line.substr(line.rfind('/') + 1);
  }
  canyon::testing::TemporaryFolder folder_;
  std::string path_ = folder_.file("log.csv");
  const Geodetic at_{45.0 * kDegree, 7.0 * kDegree, 200.0};
  /// Products of numbers of 6e6 m: a few of their epsilons.
  const double rounding_m_ = 4.0 * 6.4e6 * 2.3e-16;
};

TEST_F(StateTableTest, KfGinsFixes) {
  const auto table = read("456250.000    45.0 7.0  200.0  0.010  0.020  0.030 \n456251.5 45.0 7.0 201 1 1 1\n");
  ASSERT_TRUE(table.ok()) << table.error().str();
  ASSERT_EQ(table->rows.size(), 2U);
  EXPECT_FALSE(table->has_week);
  EXPECT_EQ(table->rows[1].t, GpsTime::from_week_sow(0, 456251.5));
  const StateRow& row = table->rows[0];
  EXPECT_LT((row.p - ecef_from_geodetic(at_)).norm(), rounding_m_);
  const Eigen::Matrix3d R = rotation_E_from_enu(at_);
  const Eigen::Vector3d enu = (R.transpose() * row.p_covariance * R).diagonal();
  EXPECT_NEAR(enu.x(), 4e-4, 1e-18);
  EXPECT_NEAR(enu.y(), 1e-4, 1e-18);
  EXPECT_NEAR(enu.z(), 9e-4, 1e-18);
  EXPECT_FALSE(row.v.allFinite());
  EXPECT_FALSE(row.R.has_value());
}

TEST_F(StateTableTest, NamesUnitsAndFactorsInAnyOrder) {
  const auto table = read(
      "lon_rad,note,h_mm*2,lat_deg,t_ms,vn_kmh,ve,vd_mps,sd_n_cm,sd_e,sd_u,roll_deg,pitch_deg,yaw_rad\n"
      "0.5,abc,1000,45,1500,36,2,-3,10,0.2,0.3,1,2,0.1\n");
  ASSERT_TRUE(table.ok()) << table.error().str();
  const StateRow& row = table->rows[0];
  const Geodetic at{45.0 * kDegree, 0.5, 2.0};
  EXPECT_EQ(row.t.ns, 1'500'000'000);
  EXPECT_LT((row.p - ecef_from_geodetic(at)).norm(), rounding_m_);
  EXPECT_LT((rotation_E_from_enu(at).transpose() * row.v - Eigen::Vector3d(2, 10, 3)).norm(), 1e-14);
  ASSERT_TRUE(row.R.has_value());
  EXPECT_LT(row.R->angularDistance(attitude_from_ned(at, kDegree, 2 * kDegree, 0.1)), 1e-14);
}

TEST_F(StateTableTest, EarthFixedPlacesWithQuaternionsAndCovariances) {
  const Eigen::Vector3d p = ecef_from_geodetic(at_);
  char line[300];
  std::snprintf(line, sizeof line, "2200,1000.000000001,%.6f,%.6f,%.6f,0.5,0.5,0.5,0.5,4,1,0,5,2,6,1.5,-2,3\n", p.x(),
                p.y(), p.z());
  const auto table =
      read("gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz,xx_m2,xy_m2,xz_m2,yy_m2,yz_m2,zz_m2,vx_m_s,vy_m_s,vz_m_s\n" +
           std::string(line));
  ASSERT_TRUE(table.ok()) << table.error().str();
  EXPECT_TRUE(table->has_week);
  EXPECT_FALSE(table->local);
  const StateRow& row = table->rows[0];
  EXPECT_EQ(row.t.ns, GpsTime::from_week_sow(2200, 1000.0).ns + 1);
  EXPECT_LT((row.p - p).norm(), 1e-6);
  EXPECT_EQ(row.p_covariance(0, 1), 1.0);
  EXPECT_EQ(row.p_covariance(2, 1), 2.0);
  EXPECT_EQ(row.v, Eigen::Vector3d(1.5, -2, 3));
  EXPECT_LT(row.R->angularDistance(Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)), 1e-14);
}

TEST_F(StateTableTest, TumIsLocal) {
  const auto table = read("# t x y z qx qy qz qw\n1306300000.25 1 2 3 0 0 0 1\n");
  ASSERT_TRUE(table.ok()) << table.error().str();
  EXPECT_TRUE(table->local);
  EXPECT_EQ(table->rows[0].p, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(table->rows[0].t.ns, 1'306'300'000'250'000'000);
}

TEST_F(StateTableTest, RtklibSolutions) {
  const std::string names = "latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)  age(s)\n";
  const auto gps = read("% program\n%  GPST  " + names + "2010/12/04 00:30:00.500 45 7 200 2 9 0.1 0.2 0.3 0\n");
  ASSERT_TRUE(gps.ok()) << gps.error().str();
  EXPECT_EQ(gps->rows[0].t, GpsTime::from_week_sow(1612, 520200.5));
  EXPECT_EQ(gps->rows[0].quality, 2);
  EXPECT_LT((gps->rows[0].p - ecef_from_geodetic(at_)).norm(), rounding_m_);
  const auto utc = read("%  UTC   " + names + "2010/12/04 00:30:00.500 45 7 200 2 9 0.1 0.2 0.3 0\n");
  EXPECT_EQ(utc->rows[0].t, GpsTime::from_week_sow(1612, 520215.5));  // 15 leap seconds then
  const auto weeks = read("%  GPST  " + names + "1612 520200.500 45 7 200 2 9 0.1 0.2 0.3 0\n");
  EXPECT_EQ(weeks->rows[0].t, gps->rows[0].t);
}

TEST_F(StateTableTest, WhatSaysNothingIsPassedOverAndCounted) {
  const auto table = read(
      "sow,lat_deg,lon_deg,h_m,status\n1,45,7,200,single\n2,,,,none\n3,45,7,nan,single\nnan,45,7,200,single\n"
      "4,45,7,200,single\n4,45,7,201,single\n1e6,45,7,200,single\n5,45,7,200,single\n2,45,7,200,single\n6,45,7,200,"
      "single\n");
  ASSERT_TRUE(table.ok()) << table.error().str();
  std::vector<double> times;
  for (const StateRow& row : table->rows) times.push_back(row.t.sow_s());
  // 1e6 s is 395200 s of the week after; it goes since what follows goes on where the log was.
  EXPECT_EQ(times, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_FALSE(table->rows[1].solved);
  EXPECT_FALSE(table->rows[2].solved);
  const PassedOver& over = table->passed_over;
  EXPECT_EQ(over.not_finite.count, 1U);
  EXPECT_EQ(over.not_finite.line, 5);
  EXPECT_EQ(over.not_finite.after_s, 3.0);
  EXPECT_EQ(over.duplicates.count, 1U);
  EXPECT_EQ(over.duplicates.line, 7);
  EXPECT_EQ(over.duplicates.t_s, 4.0);
  EXPECT_EQ(over.reversed.count, 2U);
  EXPECT_EQ(over.reversed.line, 9);
  EXPECT_EQ(over.reversed.t_s, 5.0);
  EXPECT_EQ(over.reversed.after_s, 1e6);
}

TEST_F(StateTableTest, MistakesWordForWord) {
  EXPECT_EQ(mistake("sow,lat_deg,lon_deg\n1,2,3\n"),
            "log.csv:1: no place among the columns, expected a time (sow or t_s) and a place (lat_deg,lon_deg,h_m or "
            "x_m,y_m,z_m) among the columns");
  EXPECT_EQ(mistake("lat_deg,lon_deg,h_m\n1,2,3\n").substr(0, 37), "log.csv:1: no time among the columns,");
  EXPECT_EQ(mistake("sow,lat_deg,lat_rad,lon_deg,h_m\n1,2,3,4,5\n"), "log.csv:1: two columns for lat, expected one");
  EXPECT_EQ(mistake("sow,lat_deg,lon_deg,h_m\n1,95,3,4\n"), "log.csv:2: latitude 95, expected degrees from -90 to 90");
  EXPECT_EQ(mistake("sow,lat_deg,lon_deg,h_m\n1,x,3,4\n"),
            "log.csv:2: \"x\" is not a finite number, expected a number");
  EXPECT_EQ(mistake("sow,lat_deg,lon_deg,h_m\n1,2,3\n"), "log.csv:2: 3 fields, expected 4 or more");
  EXPECT_EQ(
      mistake("1 2 3\n"),
      "log.csv:1: 3 columns without a header, expected a header of names, or 7, 8, 11 or 13 columns as of KF-GINS and "
      "TUM");
  EXPECT_EQ(mistake("sow,x_m,y_m,z_m\n1,1,2,3\n2,6378137,0,0\n"),
            "log.csv:2: a place in another frame than those of other lines, expected one frame");
  EXPECT_EQ(mistake(""), "log.csv: holds no solutions, expected at least one line of numbers");
}

}  // namespace
}  // namespace canyon
