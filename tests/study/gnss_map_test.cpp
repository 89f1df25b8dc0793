#include "canyon/study/gnss_map.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/scene/city/city.h"

namespace canyon::study {
namespace {

class GnssMapTest : public ::testing::Test {
 protected:
  static GnssMapConfig config() {
    GnssMapConfig c;
    c.gnss = mission::MissionFile::load("")->resolve("high")->gnss;
    c.start = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
    c.cell_m = 40.0;
    c.epochs = 2;
    return c;
  }
};

TEST_F(GnssMapTest, StreetsAreWorseThanOpenFieldsAndBuildingsHaveNoValue) {
  const scene::Scene city(scene::make_city({}));
  const auto map = map_gnss(config(), city, nullptr);
  ASSERT_TRUE(map.ok());
  int without_value = 0;
  double least = 1e9, most = 0.0;
  for (int row = 0; row < map->visible.rows; ++row)
    for (int column = 0; column < map->visible.columns; ++column) {
      const Eigen::Vector2d xy(map->visible.west_m + 40.0 * (column + 0.5), map->visible.south_m + 40.0 * (row + 0.5));
      const double visible = map->visible.at(column, row);
      EXPECT_EQ(std::isnan(visible), city.building_at(xy) != nullptr || !city.ground(xy.x(), xy.y()));
      without_value += std::isnan(visible) ? 1 : 0;
      if (std::isfinite(visible)) {
        least = std::min(least, visible);
        most = std::max(most, visible);
      }
    }
  EXPECT_GT(without_value, 10);
  EXPECT_LE(least, 2.0);  // the tall quarter
  EXPECT_GE(most, 7.0);   // the open edges
}

TEST_F(GnssMapTest, SameBitsForAnyNumberOfThreads) {
  const scene::Scene city(scene::make_city({}));
  set_threads(1);
  const auto one = map_gnss(config(), city, nullptr);
  set_threads(8);
  const auto eight = map_gnss(config(), city, nullptr);
  set_threads(0);
  ASSERT_TRUE(one.ok() && eight.ok());
  for (std::size_t i = 0; i < one->gdop.values.size(); ++i) {
    const double a = one->error_horizontal_m.values[i], b = eight->error_horizontal_m.values[i];
    EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << i;
  }
}

// Hours apart, a satellite that has risen since counts at once: the median GDOP of a day is that of its hours measured
// one by one.
TEST_F(GnssMapTest, ADayIsItsHours) {
  scene::CityConfig empty;
  empty.empty = true;
  const scene::Scene field(scene::make_city(empty));
  GnssMapConfig c = config();
  c.gnss.position.raim = "none";  // what it excludes depends on the noise
  c.cell_m = 1000.0;
  c.step_s = 3600.0;
  c.epochs = 11;
  const auto day = map_gnss(c, field, nullptr);
  ASSERT_TRUE(day.ok());
  std::vector<double> gdop;
  c.epochs = 1;
  for (int k = 0; k < 11; ++k) {
    const auto hour = map_gnss(c, field, nullptr);
    ASSERT_TRUE(hour.ok());
    gdop.push_back(hour->gdop.values[0]);
    c.start = c.start + 3600.0;
  }
  std::sort(gdop.begin(), gdop.end());
  EXPECT_NEAR(day->gdop.values[0], gdop[5], 1e-5);  // the fixes, metres apart by noise, see the sky alike
}

TEST_F(GnssMapTest, UnreadableNavigationFileIsTold) {
  scene::CityConfig empty;
  empty.empty = true;
  const scene::Scene field(scene::make_city(empty));
  GnssMapConfig c = config();
  c.gnss.satellites.nav_file = "/nowhere/x.nav";
  EXPECT_FALSE(map_gnss(c, field, nullptr).ok());
}

}  // namespace
}  // namespace canyon::study
