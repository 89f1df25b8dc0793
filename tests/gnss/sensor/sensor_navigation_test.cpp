#include <cmath>
#include <cstdio>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/tests/gnss/rinex/nav_text.h"
#include "canyon/tests/gnss/sensor/gnss_keys.h"
#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"
#include "canyon/tests/support/temporary_folder.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using testing::errors_off;
using ::testing::HasSubstr;
using testing::PseudorangeSensorTest;
using testing::WallScene;

TEST_F(PseudorangeSensorTest, NavigationFileFromDisk) {
  const GpsTime day = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);
  const std::string path = canyon::testing::temporary_file("day.10n");
  std::string text = testing::navigation_text(day, 31, 3, false);
  text.resize(text.size() - 100);
  ASSERT_TRUE(write_text_file(path, text).ok());
  GnssConfig c = errors_off();
  c.satellites.nav_file = path;
  const auto sensor = make(c, 1, day);
  for (const std::int64_t k : {0, 60, 960}) {
    const GnssOutput out = measure(*sensor, k, day);
    ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
    EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4);
    for (const auto& o : out.epoch.observations) EXPECT_NE(o.clock_m, 0.0);
  }
  ASSERT_EQ(sensor->warnings().size(), 1u);
  EXPECT_THAT(sensor->warnings()[0], HasSubstr("G31: the record has 7 lines, expected 8; skipped"));
  EXPECT_THAT(
      error_of(c),
      HasSubstr(": gnss.nav_file: covers 2010-06-30T22:00:00 to 2010-07-01T06:00:00 GPS time, not the mission's"));
  std::remove(path.c_str());
  EXPECT_THAT(error_of(c), HasSubstr("day.10n"));
}

// Satellites fade out one by one, each when its light time puts the transmission past the fit interval; clocks are off
// by up to 0.3 ms, so that for moments the truth still has an ephemeris and the receiver none.
TEST_F(PseudorangeSensorTest, EphemeridesExpireGracefully) {
  const GpsTime day = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);
  const std::string path = canyon::testing::temporary_file("expiry.10n");
  ASSERT_TRUE(write_text_file(path, testing::navigation_text(day, 31, 1, false)).ok());
  GnssConfig c = errors_off();
  c.satellites.nav_file = path;
  const auto sensor = make(c, 1, day);
  std::size_t before = 99;
  for (double dt_s = 0.060; dt_s < 0.095; dt_s += 2e-5) {
    const auto out = sensor->measure(0, day + (7200.0 + dt_s), antenna_W, still, scene::SceneAt(*scene));
    EXPECT_LE(out.epoch.observations.size(), before);
    before = out.epoch.observations.size();
  }
  EXPECT_EQ(before, 0u);
}

TEST_F(PseudorangeSensorTest, RealNavigationFile) {
  CANYON_REAL_DATA(path, "gnss/orbit_2010_182/brdc1820.10n");
  const GpsTime start = GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0);
  GnssConfig c = errors_off();
  c.satellites.nav_file = path;
  const auto sensor = make(c, 1, start);
  std::set<std::size_t> counts;
  for (std::int64_t k = 0; k <= 960; k += 60) {
    const GnssOutput out = measure(*sensor, k, start);
    ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
    EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4);
    counts.insert(out.epoch.observations.size());
  }
  EXPECT_GE(*counts.begin(), 6u);  // 30 healthy satellites that day
  EXPECT_LE(*counts.rbegin(), 14u);
}

// Real broadcasts of five systems at once, each with its own receiver clock, frequencies and modulation.
TEST_F(PseudorangeSensorTest, RealMultiGnss) {
  CANYON_REAL_DATA(path, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_MN.rnx.gz");
  scene = WallScene(Geodetic{55.5 * kDegree, 8.46 * kDegree, 60.0}).wall({0, 0, -5}, {1, 0, 0}, {0, 1, 0}).build();
  const GpsTime start = GpsTime::from_calendar(2020, 6, 25, 12, 0, 0.0);
  GnssConfig c = errors_off();
  c.satellites.nav_file = path;
  c.satellites.systems = "GREC";
  const auto sensor = make(c, 1, start);
  std::set<GnssSystem> systems;
  for (const std::int64_t k : {0, 400, 900}) {
    const GnssOutput out = measure(*sensor, k, start);
    ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
    // GLONASS is integrated numerically by receiver and truth alike.
    EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-3);
    for (const auto& o : out.epoch.observations) {
      systems.insert(o.sv.system);
      EXPECT_TRUE(o.used);
    }
  }
  EXPECT_EQ(systems.size(), 4u);
  c.mode.name = "dual";
  const GnssOutput dual = measure(*make(c, 1, start), 0, start);
  EXPECT_LT((dual.fix.p_A_E - truth_E()).norm(), 1e-3);
}

// What the broadcast of 1 July 2010 really erred by, on ranges: like the model that was made from it.
TEST_F(PseudorangeSensorTest, RealOrbitErrors) {
  CANYON_REAL_DATA(nav, "gnss/orbit_2010_182/brdc1820.10n");
  CANYON_REAL_DATA(sp3, "gnss/orbit_2010_182/igs15904.sp3");
  CANYON_REAL_DATA(antex, "gnss/antex/igs05.atx.gz");
  const GpsTime start = GpsTime::from_calendar(2010, 7, 1, 4, 0, 0.0);
  GnssConfig c = errors_off();
  c.satellites.nav_file = nav;
  testing::set_keys(c, "sp3_files = [\"" + sp3 + "\"]\nantex_file = \"" + antex + "\"");
  c.ephemeris_error.name = "broadcast_minus_sp3";
  auto sensor = make_gnss_sensor(c, 1, start, start + 14.0 * 3600.0, *scene);
  ASSERT_TRUE(sensor.ok()) << sensor.error().str();
  double square = 0.0;
  int n = 0;
  for (std::int64_t k = 0; k < 56; ++k) {
    const GnssOutput out =
        (*sensor)->measure(k, start + 900.0 * static_cast<double>(k), antenna_W, still, scene::SceneAt(*scene));
    double mean_m = 0.0;
    for (const auto& s : out.truth.satellites)
      mean_m += s.ephemeris_m / static_cast<double>(out.truth.satellites.size());
    for (const auto& s : out.truth.satellites) {
      square += std::pow(s.ephemeris_m - mean_m, 2);  // what is common goes into the receiver's clock
      ++n;
    }
    ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
    EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 8.0);
  }
  const double rms_m = std::sqrt(square / n);
  RecordProperty("rms_m", std::to_string(rms_m));
  std::printf("broadcast minus SP3 on ranges at Vicksburg, against the epoch's mean: %.2f m RMS of %d\n", rms_m, n);
  EXPECT_GT(rms_m, 0.4);
  EXPECT_LT(rms_m, 1.3);
}

TEST_F(PseudorangeSensorTest, SystemsOfTheBuiltInConstellation) {
  GnssConfig c = errors_off();
  c.satellites.systems = "GRECJ";
  const GnssOutput out = measure(*make(c), 0);
  std::set<GnssSystem> systems;
  for (const auto& o : out.epoch.observations) systems.insert(o.sv.system);
  EXPECT_GE(systems.size(), 4u);
  EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4);
}

TEST_F(PseudorangeSensorTest, IonosphereMaps) {
  GnssConfig c;
  c.ionosphere.name = "ionex";
  EXPECT_EQ(error_of(c), "gnss.ionosphere: is \"ionex\", but there are no maps, expected gnss.ionex_file");
  CANYON_REAL_DATA(path, "gnss/orbit_2010_182/igrg3380.10i");
  testing::set_keys(c, "ionex_file = \"" + path + "\"");
  EXPECT_THAT(error_of(c), HasSubstr("igrg3380.10i: gnss.ionex_file: covers 2010-12-04T00:00:1"));
  const GpsTime start = GpsTime::from_calendar(2010, 12, 4, 13, 0, 0.0);
  const GnssOutput out = measure(*make(c, 1, start), 0, start);
  EXPECT_EQ(out.fix.status, FixStatus::kDifferential);
}

TEST_F(PseudorangeSensorTest, MeasuredOrbitErrorsNeedTheirFiles) {
  GnssConfig c;
  c.ephemeris_error.name = "broadcast_minus_sp3";
  EXPECT_EQ(error_of(c),
            "gnss.ephemeris_error: is \"broadcast_minus_sp3\", but there is no broadcast, expected gnss.nav_file");
  c = GnssConfig{};
  c.satellites.systems = "GX";
  EXPECT_THAT(error_of(c), HasSubstr("gnss.systems: "));
}

}  // namespace
}  // namespace canyon::gnss
