#include "canyon/core/files/place_files.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

class PlaceFilesTest : public ::testing::Test {
 protected:
  PlaceFilesTest() : path_(testing::temporary_file("places.csv")) {}
  ~PlaceFilesTest() override { std::filesystem::remove(path_); }
  Result<std::vector<StampedPlace>> read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_places(path_);
  }
  std::string message(const std::string& text) {
    const auto places = read(text);
    return places ? "no error" : places.error().str().substr(path_.size());
  }
  std::string path_;
};

TEST_F(PlaceFilesTest, GeodeticAndEcefWithAndWithoutHeader) {
  const Geodetic g{32.35 * kDegree, -90.88 * kDegree, 61.5};
  const Eigen::Vector3d p = ecef_from_geodetic(g);
  char ecef[120];
  std::snprintf(ecef, sizeof ecef, "1610,306000.25,%.4f,%.4f,%.4f\n", p.x(), p.y(), p.z());
  const std::string geodetic = "1610,306000.25,32.35,-90.88,61.5\n";
  for (const std::string& text :
       {geodetic, std::string(ecef), "gps_week,sow,lat_deg,lon_deg,h_m\n" + geodetic,
        "gps_week,sow,x_m,y_m,z_m\n" + std::string(ecef), std::string("1610 306000.25 32.35 -90.88 61.5\n"),
        std::string("h_m,lon_deg,sow,lat_deg,gps_week,extra\n61.5,-90.88,306000.25,32.35,1610,x\n")}) {
    const auto places = read(text);
    ASSERT_TRUE(places.ok()) << places.error().str();
    ASSERT_EQ(places->size(), 1U);
    EXPECT_EQ(places->front().t, GpsTime::from_week_sow(1610, 306000.25));
    EXPECT_NEAR((places->front().p_E - p).norm(), 0.0, 1e-4);  // four decimals of a metre
  }
}

TEST_F(PlaceFilesTest, MistakesNameTheLine) {
  EXPECT_EQ(message(""), ": holds no places, expected at least one line of numbers");
  EXPECT_EQ(
      message("time,lat\n1,2\n"),
      ":1: header without the columns needed, expected gps_week,sow,lat_deg,lon_deg,h_m or gps_week,sow,x_m,y_m,z_m");
  EXPECT_EQ(message("1610,1.0,32.0\n"),
            ":1: 3 fields, expected at least 5: gps_week,sow,lat_deg,lon_deg,h_m or gps_week,sow,x_m,y_m,z_m");
  EXPECT_EQ(message("1610,1.0,95.0,0,0\n"), ":1: no such place, expected degrees, degrees, metres");
  EXPECT_EQ(message("1610,700000,35.0,0,0\n"), ":1: no such time, expected a GPS week and seconds of week");
  EXPECT_EQ(message("1610,2,35.0,0,0\n1610,2,35.0,0,0\n"),
            ":2: time does not increase, expected places in the order of time");
}

// A cubic in time is met to third order: halving the step cuts the position error of a circle by 8 or more.
TEST(PlacePath, ConvergesOnACircleWithContinuousVelocity) {
  const auto error = [](double step_s) {
    std::vector<StampedPlace> places;
    for (double t = 0.0; t <= 40.0 + 1e-9; t += step_s)
      places.push_back({GpsTime{} + t, {100.0 * std::cos(0.1 * t), 100.0 * std::sin(0.1 * t), 3.0 * t}});
    const PlacePath path(places);
    double worst_p = 0.0, worst_v = 0.0;
    for (double t = 10.0; t <= 30.0; t += 0.13) {
      const auto state = path.at(GpsTime{} + t);
      const Eigen::Vector3d p(100.0 * std::cos(0.1 * t), 100.0 * std::sin(0.1 * t), 3.0 * t);
      const Eigen::Vector3d v(-10.0 * std::sin(0.1 * t), 10.0 * std::cos(0.1 * t), 3.0);
      worst_p = std::max(worst_p, (state->p_E - p).norm());
      worst_v = std::max(worst_v, (state->v_E - v).norm());
    }
    return std::pair(worst_p, worst_v);
  };
  const auto coarse = error(1.0), fine = error(0.5);
  EXPECT_LT(fine.first, coarse.first / 7.0);
  EXPECT_LT(fine.second, coarse.second / 3.5);
  EXPECT_LT(fine.first, 1e-3);
}

TEST(PlacePath, EndsAndSinglePlace) {
  const PlacePath one({{GpsTime{} + 5.0, {1, 2, 3}}});
  EXPECT_EQ(one.at(GpsTime{} + 100.0)->p_E, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(one.at(GpsTime{})->v_E, Eigen::Vector3d(0, 0, 0));
  const PlacePath two({{GpsTime{}, {0, 0, 0}}, {GpsTime{} + 2.0, {4, 0, 0}}});
  EXPECT_EQ(two.at(GpsTime{} + 2.0)->p_E, Eigen::Vector3d(4, 0, 0));
  EXPECT_EQ(two.at(GpsTime{} + 1.0)->v_E, Eigen::Vector3d(2, 0, 0));
  EXPECT_FALSE(two.at(GpsTime{} + 2.001).has_value());
  EXPECT_FALSE(two.at(GpsTime{} - 0.001).has_value());
}

}  // namespace
}  // namespace canyon
