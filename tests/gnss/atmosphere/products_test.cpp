#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/products/almanac_file.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/satellites/sun.h"
#include "canyon/tests/gnss/atmosphere/product_text.h"
#include "canyon/tests/gnss/rinex/damage.h"
#include "canyon/tests/gnss/rinex/nav_text.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using testing::antex_text;
using testing::broadcast_of;
using testing::clock_text;
using ::testing::ElementsAre;
using testing::ionex_text;
using testing::sample_ephemeris;
using testing::sem_text;
using testing::sp3_text;
using testing::yuma_text;

const GpsTime kStart = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);
const SatelliteId kG01{GnssSystem::kGps, 1};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// --- RINEX clocks

TEST(ClockFile, LinearBetweenItsSamples) {
  const auto file = parse_clock_file(clock_text(kStart, 5, 300.0), "igs.clk");
  ASSERT_TRUE(file.ok()) << file.error().str();
  EXPECT_TRUE(file->warnings.empty());
  EXPECT_EQ(file->interval_s, 300.0);
  EXPECT_EQ(file->satellites.size(), 2u);
  EXPECT_DOUBLE_EQ(file->clock_s(kG01, kStart + 600.0), 1e-4 + 2e-9);
  EXPECT_NEAR(file->clock_s(kG01, kStart + 675.0), 1e-4 + 2.25e-9, 1e-18);
  EXPECT_TRUE(std::isnan(file->clock_s(kG01, kStart - 1.0)));
  EXPECT_TRUE(std::isnan(file->clock_s(kG01, kStart + 1201.0)));
  EXPECT_TRUE(std::isnan(file->clock_s({GnssSystem::kGps, 2}, kStart)));
}

TEST(ClockFile, GapsAndDamage) {
  std::string text = clock_text(kStart, 5, 300.0);
  const std::string third = "AS G01  2010 07 01 00 10  0.000000";
  const auto gap = parse_clock_file(replaced(text, third, "XX G01  2010 07 01 00 10  0.000000"), "igs.clk");
  EXPECT_TRUE(std::isnan(gap->clock_s(kG01, kStart + 600.0)));
  EXPECT_FALSE(std::isnan(gap->clock_s({GnssSystem::kGps, 9}, kStart + 600.0)));
  const auto damaged = parse_clock_file(replaced(text, third, "AS G01  2010 07 41 00 10  0.000000"), "igs.clk");
  EXPECT_THAT(damaged->warnings, ElementsAre("igs.clk:11: the clock of G01 cannot be read; skipped"));
  const auto error = [](const std::string& bad) { return parse_clock_file(bad, "igs.clk").error().str(); };
  EXPECT_EQ(error(""), "igs.clk:1: the file is empty, expected a RINEX clock file of version 2 or 3");
  EXPECT_EQ(
      error("hello\n"),
      "igs.clk:1: not a RINEX clock file: the first line has no version and type \"C\", expected a RINEX clock file "
      "of version 2 or 3");
  EXPECT_EQ(error(text.substr(0, text.find("AR ALBH"))),
            "igs.clk:3: no satellite clock, expected lines that start with \"AS\"");
  EXPECT_EQ(error(text.substr(0, text.find("END OF HEADER"))),
            "igs.clk:3: the file ends inside its header, expected a line \"END OF HEADER\"");
  const auto read = [](const std::string& bad) { (void)parse_clock_file(bad, "damaged.clk"); };
  testing::for_each_truncation(text, read);
  testing::for_each_damage(text, 300, 10, read);
}

TEST(ClockFile, CompletesPreciseOrbits) {
  auto first = sample_ephemeris(1, kStart + 10800.0);
  first.valid_before_s = first.valid_after_s = 4.0 * 3600.0;
  const auto truth = broadcast_of({first});
  const auto orbits = parse_sp3_file(sp3_text(*truth, kStart, 900.0, 20), "twin.sp3");
  const auto clocks = parse_clock_file(clock_text(kStart, 60, 300.0), "igs.clk");
  const auto precise = make_precise(*orbits, {.clocks = &*clocks});
  const auto state = precise->state(kG01, kStart + 3000.0);
  ASSERT_TRUE(state.has_value());
  EXPECT_NEAR(state->clock_s - testing::periodic_relativity_s(*state), 1e-4 + 1e-8, 1e-15);
}

// The combined clocks at 15 minutes are the same in both products of the day.
TEST(ClockFile, RealClocksAgreeWithTheSp3File) {
  CANYON_REAL_DATA(clk, "gnss/orbit_2010_182/igs15904.clk");
  CANYON_REAL_DATA(sp3, "gnss/orbit_2010_182/igs15904.sp3");
  const auto clocks = read_clock_file(clk);
  const auto orbits = read_sp3_file(sp3);
  ASSERT_TRUE(clocks.ok() && orbits.ok());
  EXPECT_EQ(clocks->interval_s, 300.0);
  int n = 0;
  for (const auto& [sv, samples] : orbits->satellites)
    for (const auto& s : samples) {
      const double clock_s = clocks->clock_s(sv, s.t);
      if (std::isnan(clock_s) || std::isnan(s.clock_s)) continue;
      EXPECT_NEAR(clock_s, s.clock_s, 1e-11) << sv.str();  // the SP3 file has 1 ps
      ++n;
    }
  EXPECT_GT(n, 100);
}

// --- ANTEX

TEST(Antex, SatellitesByTimeAndReceiversByName) {
  const auto file = parse_antex_file(antex_text(), "igs.atx");
  ASSERT_TRUE(file.ok()) << file.error().str();
  EXPECT_TRUE(file->warnings.empty());
  ASSERT_EQ(file->antennas.size(), 3u);
  EXPECT_EQ(file->satellite(kG01, kStart)->pattern("G01")->offset_m.z(), 2.5);
  EXPECT_EQ(file->satellite(kG01, GpsTime::from_calendar(2005, 1, 1, 0, 0, 0.0))->pattern("G01")->offset_m.z(), 2.0);
  EXPECT_EQ(file->satellite(kG01, GpsTime::from_calendar(1990, 1, 1, 0, 0, 0.0)), nullptr);
  EXPECT_EQ(file->satellite({GnssSystem::kGps, 2}, kStart), nullptr);
  const Antenna* receiver = file->receiver("TRM29659.00     NONE");
  ASSERT_NE(receiver, nullptr);
  EXPECT_EQ(file->receiver("TRM29659.00     SNOW"), receiver);  // radome not calibrated
  EXPECT_EQ(file->receiver("BLOCK IIA"), nullptr);
  const AntennaPattern& p = *receiver->pattern("G01");
  EXPECT_NEAR(p.offset_m.z(), 0.09195, 1e-12);
  EXPECT_NEAR(p.offset_m.y(), -0.00091, 1e-12);
  EXPECT_EQ(receiver->pattern("G05"), nullptr);
  // By construction: zenith angle in deg / 10 + azimuth / 90, in mm; bilinear is exact.
  EXPECT_NEAR(p.variation_m(45.0 * kDegree, 0.0), 4.5e-3, 1e-12);
  EXPECT_NEAR(p.variation_m(45.0 * kDegree, 135.0 * kDegree), 6.0e-3, 1e-12);
  EXPECT_NEAR(p.variation_m(10.0 * kDegree, -90.0 * kDegree), 4.0e-3, 1e-12);
  EXPECT_NEAR(p.variation_m(100.0 * kDegree, 0.0), 9.0e-3, 1e-12);
}

// z towards the Earth's centre; x towards the Sun's side, perpendicular to z.
TEST(Antex, SatelliteOffsetInTheEarthsFrame) {
  const auto file = parse_antex_file(antex_text(), "igs.atx");
  const Antenna& antenna = *file->satellite(kG01, kStart);
  const Eigen::Vector3d p_E(20e6, 10e6, 14e6), offset = satellite_offset_E(antenna, p_E, kStart);
  EXPECT_NEAR(offset.norm(), std::hypot(2.5, 0.279), 1e-12);
  EXPECT_NEAR(offset.dot(-p_E.normalized()), 2.5, 1e-12);
  EXPECT_GT((offset - 2.5 * -p_E.normalized()).dot(sun_direction_E(kStart)), 0.0);
}

TEST(Antex, ErrorsAndDamage) {
  const std::string good = antex_text();
  const auto error = [](const std::string& bad) { return parse_antex_file(bad, "igs.atx").error().str(); };
  EXPECT_EQ(error(""), "igs.atx:1: the file is empty, expected an ANTEX 1.3 or 1.4 file");
  EXPECT_EQ(
      error("hello\n"),
      "igs.atx:1: not an ANTEX file: the first line has no version and \"ANTEX VERSION / SYST\", expected an ANTEX "
      "1.3 or 1.4 file");
  EXPECT_EQ(error(replaced(good, "     1.4 ", "     2.0 ")),
            "igs.atx:1: ANTEX version 2 is not supported, expected 1.3 or 1.4");
  const auto damaged = parse_antex_file(replaced(good, "   2000.00", "   2000.x0"), "igs.atx");
  EXPECT_EQ(damaged->antennas.size(), 2u);
  EXPECT_THAT(damaged->warnings,
              ElementsAre("igs.atx:10: NORTH / EAST / UP = \"2000.x0\" is not a number; the antenna is skipped"));
  const auto read = [](const std::string& bad) {
    const auto file = parse_antex_file(bad, "damaged.atx");
    if (!file.ok()) return;
    for (const auto& a : file->antennas)
      for (const auto& [code, pattern] : a.patterns) (void)pattern.variation_m(0.5, 4.0);
  };
  testing::for_each_truncation(good, read);
  testing::for_each_damage(good, 300, 15, read);
}

TEST(Antex, RealFile) {
  CANYON_REAL_DATA(path, "gnss/antex/igs05.atx.gz");
  const auto file = read_antex_file(path);
  ASSERT_TRUE(file.ok()) << file.error().str();
  EXPECT_TRUE(file->warnings.empty());
  EXPECT_EQ(file->antennas.size(), 323u);  // as grep counts
  EXPECT_EQ(file->satellite({GnssSystem::kGps, 2}, kStart)->type, "BLOCK IIR-B");
  const Antenna* trimble = file->receiver("TRM29659.00     NONE");
  ASSERT_NE(trimble, nullptr);
  EXPECT_NEAR(trimble->pattern("G01")->offset_m.z(), 0.09195, 1e-9);
  EXPECT_NEAR(trimble->pattern("G01")->variation_m(40.0 * kDegree, 5.0 * kDegree), -8.12e-3, 1e-9);
}

// The Astronomical Almanac's own examples are in inertial coordinates; here: solstice, equinox, noon at Greenwich.
TEST(Sun, SeasonsAndNoon) {
  const auto at = [](int mo, int d, int h, int mi) {
    return sun_direction_E(GpsTime::from_calendar(2010, mo, d, h, mi, 15.0));
  };
  EXPECT_NEAR(std::asin(at(6, 21, 11, 28).z()) / kDegree, 23.44, 0.01);  // solstice of 2010, 11:28 UTC
  EXPECT_NEAR(std::asin(at(3, 20, 17, 32).z()) / kDegree, 0.0, 0.01);    // equinox, 17:32 UTC
  const Eigen::Vector3d noon = at(4, 15, 12, 0);                         // equation of time is 0 that day
  EXPECT_NEAR(std::atan2(noon.y(), noon.x()) / kDegree, 0.0, 0.1);
}

// --- IONEX

TEST(Ionex, InterpolatesInSpaceAndTurnsWithTheSun) {
  const auto maps = parse_ionex_file(ionex_text(), "igs.10i");
  ASSERT_TRUE(maps.ok()) << maps.error().str();
  EXPECT_TRUE(maps->warnings.empty());
  EXPECT_EQ(maps->shell_height_m, 450e3);
  const GpsTime first = GpsTime::from_calendar(2010, 12, 4, 0, 0, 15.0);  // UTC + 15 s
  ASSERT_EQ(maps->maps.size(), 2u);
  EXPECT_EQ(maps->maps[0].t, first);
  const auto vtec = [&](double lat_deg, double lon_deg, double after_s) {
    return maps->vtec_tecu(lat_deg * kDegree, lon_deg * kDegree, first + after_s);
  };
  // On grid points the file's rounding, 0.05; between them bilinear: the cosine's chord, 5 (15 deg)^2 / 8 = 0.04.
  EXPECT_NEAR(vtec(30.0, 0.0, 0.0), 18.0, 0.051);
  EXPECT_NEAR(vtec(15.0, 45.0, 0.0), 11.5 + 5.0 * std::cos(45.0 * kDegree), 0.051);
  EXPECT_NEAR(vtec(0.0, 97.5, 0.0), 10.0 + 5.0 * std::cos(97.5 * kDegree), 0.1);
  EXPECT_NEAR(vtec(0.0, 180.0, 0.0), vtec(0.0, -180.0, 0.0), 1e-12);
  EXPECT_NEAR(vtec(0.0, 540.0, 0.0), vtec(0.0, 180.0, 0.0), 1e-9);
  EXPECT_NEAR(vtec(85.0, 0.0, 0.0), vtec(60.0, 0.0, 0.0), 1e-12);  // the nearest row
  EXPECT_NEAR(vtec(0.0, 0.0, 7200.0), 30.0, 0.051);
  // One hour on: the first map is looked up 15 deg further east, the second 15 deg further west; the mean of both.
  const double c = 10.0 + 5.0 * std::cos(15.0 * kDegree);
  EXPECT_NEAR(vtec(0.0, 0.0, 3600.0), 0.5 * c + 0.5 * 2.0 * c, 0.1);
  EXPECT_TRUE(std::isnan(vtec(0.0, 0.0, -1.0)) && std::isnan(vtec(0.0, 0.0, 7201.0)));
}

TEST(Ionex, ErrorsAndDamage) {
  const std::string good = ionex_text();
  const auto error = [](const std::string& bad) { return parse_ionex_file(bad, "igs.10i").error().str(); };
  EXPECT_EQ(error(""), "igs.10i:1: the file is empty, expected an IONEX 1.0 or 1.1 file");
  EXPECT_EQ(error(replaced(good, "     2       ", "     3       ")), "igs.10i:2: MAP DIMENSION: \"3\", expected 2");
  EXPECT_EQ(error(replaced(good, "LAT1 / LAT2 / DLAT", "COMMENT           ")),
            "igs.10i:8: the header has no grid, expected \"LAT1 / LAT2 / DLAT\" and \"LON1 / LON2 / DLON\"");
  const auto damaged = parse_ionex_file(replaced(good, "\n  110", "\n  1x0"), "igs.10i");
  ASSERT_TRUE(damaged.ok());
  EXPECT_EQ(damaged->maps.size(), 1u);
  EXPECT_THAT(damaged->warnings, ElementsAre("igs.10i:9: the map is damaged at line 12 and is skipped"));
  const auto read = [](const std::string& bad) {
    const auto maps = parse_ionex_file(bad, "damaged.10i");
    if (maps.ok()) (void)maps->vtec_tecu(0.5, 3.0, GpsTime::from_calendar(2010, 12, 4, 1, 0, 0.0));
  };
  testing::for_each_truncation(good, read);
  testing::for_each_damage(good, 200, 20, read);
}

// Vertical TEC at Vicksburg on 4 December 2010 at 12, 13 and 14 UT, as an independent program read it: 8.6, 10.7, 12.9.
TEST(Ionex, RealMapAtVicksburg) {
  CANYON_REAL_DATA(path, "gnss/orbit_2010_182/igrg3380.10i");
  const auto maps = read_ionex_file(path);
  ASSERT_TRUE(maps.ok()) << maps.error().str();
  EXPECT_TRUE(maps->warnings.empty()) << maps->warnings.front();
  EXPECT_EQ(maps->maps.size(), 13u);
  const auto at = [&](int hour) {
    return maps->vtec_tecu(32.35 * kDegree, -90.88 * kDegree, GpsTime::from_calendar(2010, 12, 4, hour, 0, 15.0));
  };
  EXPECT_NEAR(at(12), 8.6, 0.06);
  EXPECT_NEAR(at(14), 12.9, 0.06);
  // Between the maps the two programs may differ: with or without turning with the Sun, 8 deg of longitude.
  EXPECT_NEAR(at(13), 10.7, 0.5);
}

// --- almanacs

TEST(Almanac, YumaAndSemSayTheSame) {
  const GpsTime near = GpsTime::from_calendar(2016, 4, 1, 0, 0, 0.0);
  const auto yuma = parse_almanac_file(yuma_text(), "current.alm", near),
             sem = parse_almanac_file(sem_text(), "current.al3", near);
  ASSERT_TRUE(yuma.ok()) << yuma.error().str();
  ASSERT_TRUE(sem.ok()) << sem.error().str();
  for (const auto* data : {&*yuma, &*sem}) {
    EXPECT_TRUE(data->warnings.empty());
    ASSERT_EQ(data->kepler.size(), 2u);
    EXPECT_EQ(data->kepler[0].toe, GpsTime::from_week_sow(866 + 1024, 589824.0));
    EXPECT_TRUE(data->kepler[0].healthy());
    EXPECT_FALSE(data->kepler[1].healthy());
  }
  // YUMA's inclination and perigee have nine or ten decimals: 5e-10 rad of 26,560 km.
  for (std::size_t k = 0; k < 2; ++k) {
    const GpsTime t = near + 3600.0;
    EXPECT_LT((yuma->kepler[k].at(t).p_E - sem->kepler[k].at(t).p_E).norm(), 0.1);
    EXPECT_NEAR(yuma->kepler[k].at(t).clock_s, sem->kepler[k].at(t).clock_s, 1e-13);
  }
  const auto constellation = make_broadcast(*yuma);
  EXPECT_TRUE(constellation->state(kG01, near).has_value());
  EXPECT_FALSE(constellation->state(kG01, near + 30.0 * 86400.0).has_value());
  EXPECT_FALSE(constellation->state({GnssSystem::kGps, 2}, near).has_value());
}

// Weeks count modulo 1024: the turn nearest to the instant that is asked for.
TEST(Almanac, WeekRollover) {
  const auto week_near = [](int year) {
    return parse_almanac_file(yuma_text(), "a", GpsTime::from_calendar(year, 1, 1, 0, 0, 0.0))->kepler[0].toe.week();
  };
  EXPECT_EQ(week_near(1997), 866);
  EXPECT_EQ(week_near(2016), 1890);
  EXPECT_EQ(week_near(2036), 2914);
}

TEST(Almanac, ErrorsAndDamage) {
  const auto read = [](const std::string& text) { return parse_almanac_file(text, "a.alm", kStart); };
  EXPECT_EQ(read("").error().str(), "a.alm:1: the file is empty, expected a YUMA or SEM almanac");
  EXPECT_EQ(read("hello\n").error().str(),
            "a.alm:1: neither a YUMA nor a SEM almanac, expected \"******** Week ... almanac for PRN-...\" (YUMA) or a "
            "number of records (SEM)");
  EXPECT_THAT(
      read(replaced(yuma_text(), "5.2213668820E-03", "5.22136688x0E-03"))->warnings,
      ElementsAre("a.alm:4: \"Eccentricity:               5.22136688x0\" is no line of a YUMA almanac; the record "
                  "is skipped"));
  EXPECT_THAT(read(replaced(yuma_text(), "5.2213668820E-03", "5.2213668820E+03"))->warnings,
              ElementsAre("a.alm:1: e = 5221.3668820000003 cannot be; the record is skipped"));
  EXPECT_THAT(read(replaced(yuma_text(), "Health:                     000\n", ""))->warnings,
              ElementsAre("a.alm:1: the record has no \"Health\" and is skipped"));
  for (const std::string& good : {yuma_text(), sem_text()}) {
    const auto survive = [&](const std::string& bad) {
      const auto data = read(bad);
      if (!data.ok()) return;
      for (const auto& r : data->kepler) EXPECT_TRUE(r.at(r.toe).p_E.allFinite());
    };
    testing::for_each_truncation(good, survive);
    testing::for_each_damage(good, 300, 10, survive);
  }
}

// The almanac of March 2016, valid in early April, against the broadcast orbits of 6 June 2016 is two months old;
// against itself in Keplerian terms: 32 satellites in six planes at 26,560 km.
TEST(Almanac, RealYuma) {
  CANYON_REAL_DATA(path, "gnss/almanac/20160331.alm");
  const GpsTime near = GpsTime::from_calendar(2016, 3, 31, 0, 0, 0.0);
  const auto data = read_almanac_file(path, near);
  ASSERT_TRUE(data.ok()) << data.error().str();
  EXPECT_TRUE(data->warnings.empty());
  EXPECT_GE(data->kepler.size(), 30u);
  for (const auto& r : data->kepler) {
    EXPECT_LT(std::abs(r.toe - near), 7.0 * 86400.0);
    EXPECT_NEAR(r.at(near).p_E.norm(), 26560e3, 600e3) << r.sv.str();
  }
}

}  // namespace
}  // namespace canyon::gnss
