#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/satellites/contradictions.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/tests/gnss/rinex/damage.h"
#include "canyon/tests/gnss/rinex/nav_text.h"

namespace canyon::gnss {
namespace {

using ::testing::ElementsAre;
using testing::fortran;
using testing::header;
using testing::header_line;
using testing::record;
using testing::sample_ephemeris;

const GpsTime kFileToe = GpsTime::from_calendar(2023, 3, 12, 2, 0, 0.0);

std::string head4() {
  return header_line("     4.00           NAVIGATION DATA     M", "RINEX VERSION / TYPE") +
         header_line("", "END OF HEADER");
}

/// One of each kind of RINEX 4 record.
std::string rinex4_text() {
  std::string out = head4();
  const auto numbers = [](std::initializer_list<double> values) {
    std::string line = "    ";
    for (const double v : values) line += fortran(v);
    return line + "\n";
  };
  KeplerEphemeris gps = sample_ephemeris(1, kFileToe);
  gps.tgd_s = 5e-9;
  out += "> EPH G01 LNAV\n" + record(gps, true);
  out += "> ION G12 LNAV\n    2023 03 12 00 08 54" + fortran(1e-8) + fortran(2e-8) + fortran(-3e-8) + "\n" +
         numbers({4e-8, 1e5, 2e5, -3e5}) + numbers({4e5});
  out += "> ION E02 IFNV\n    2023 03 12 00 11 25" + fortran(160.75) + fortran(0.371) + fortran(9.06e-3) + "\n" +
         numbers({0.0});
  out += "> STO E   IFNV\n    2023 03 12 00 20 00 GAGP\n" + numbers({2286.0, -2.5e-8, 2.6e-14, 0.0});
  out += "> EOP G27 CNVX\n    2023 03 14 16 51 12" + fortran(-0.04) + fortran(3.9e-5) + fortran(0.0) + "\n" +
         numbers({0.0, 0.35, 2.6e-3, 0.0}) + numbers({4392.0, -0.019, -1.4e-4, 0.0});
  // BeiDou's own time: toe 02:00 BDT.
  KeplerEphemeris beidou = sample_ephemeris(20, GpsTime::from_calendar(2023, 3, 12, 2, 0, 0.0));
  beidou.sv.system = GnssSystem::kBeidou;
  beidou.iode = 0;  // stands where TGD2 does
  out += "> EPH C20 D1\n" + record(beidou, true);
  // CNAV: nine lines, toe is toc, the third line starts with t_op.
  out += "> EPH G05 CNAV\nG05 2023 03 12 01 30 00" + fortran(1e-4) + fortran(0.0) + fortran(0.0) + "\n" +
         numbers({0.01, -70.0, 3.6e-9, 3.1}) + numbers({-3.7e-6, 0.0125, 1.2e-5, 5153.65}) +
         numbers({542700.0, 3.5e-8, -2.6, -2e-7}) + numbers({0.99, 157.8, 0.94, -7.4e-9}) +
         numbers({-1.9e-11, -1.1e-13, -6.0, 2.0}) + numbers({-1.0, 1.0, 4.7e-9, 7.0}) +
         numbers({-3.5e-10, -2.5e-9, 7.2e-9, 7.3e-9}) + numbers({6.0, 2252.0});
  return out;
}

TEST(Rinex4, EveryKindOfRecord) {
  const auto file = parse_navigation_file(rinex4_text(), "brd4.rnx");
  ASSERT_TRUE(file.ok()) << file.error().str();
  EXPECT_TRUE(file->warnings.empty()) << file->warnings.front();
  ASSERT_EQ(file->kepler.size(), 3u);
  EXPECT_EQ(file->kepler[0].message, NavigationMessage::kLnav);
  EXPECT_EQ(file->kepler[0].toe, kFileToe);
  EXPECT_EQ(file->kepler[0].transmitted, std::optional(kFileToe - 3600.0));
  EXPECT_EQ(file->kepler[1].message, NavigationMessage::kD1);
  EXPECT_EQ(file->kepler[1].toe, kFileToe + 14.0);
  EXPECT_EQ(file->kepler[1].toc, kFileToe + 14.0);
  const KeplerEphemeris& cnav = file->kepler[2];
  EXPECT_EQ(cnav.message, NavigationMessage::kCnav);
  EXPECT_EQ(cnav.toe, GpsTime::from_calendar(2023, 3, 12, 1, 30, 0.0));
  EXPECT_DOUBLE_EQ(cnav.a_dot_m_s, 0.01);
  EXPECT_DOUBLE_EQ(cnav.delta_n_dot_rad_s2, -1.1e-13);
  EXPECT_DOUBLE_EQ(cnav.isc_s[5], 7.2e-9);
  EXPECT_DOUBLE_EQ(cnav.accuracy_m, std::sqrt(2.0));  // URA index -1
  EXPECT_TRUE(cnav.healthy());                        // 1: L5 alone
  EXPECT_EQ(cnav.transmitted, std::optional(GpsTime::from_week_sow(2253, 6.0)));

  const auto klobuchar = file->klobuchar_at(GnssSystem::kGps, kFileToe);
  ASSERT_TRUE(klobuchar.has_value());
  EXPECT_THAT(klobuchar->alpha, ElementsAre(1e-8, 2e-8, -3e-8, 4e-8));
  EXPECT_THAT(klobuchar->beta, ElementsAre(1e5, 2e5, -3e5, 4e5));
  EXPECT_FALSE(file->klobuchar_at(GnssSystem::kBeidou, kFileToe).has_value());
  EXPECT_EQ(file->skipped_records,
            (std::map<std::string, int>{{"EOP G CNVX", 1}, {"ION E IFNV", 1}, {"STO E IFNV", 1}}));
  EXPECT_EQ(file->skipped(), "1 EOP G CNVX, 1 ION E IFNV, 1 STO E IFNV");
}

TEST(Rinex4, DamagedRecordsAreSkippedWithTheirLine) {
  const std::string good = "> EPH G02 LNAV\n" + record(sample_ephemeris(2, kFileToe), true);
  const auto warnings_of = [&](const std::string& bad) {
    const auto file = parse_navigation_file(head4() + bad + good, "brd4.rnx");
    EXPECT_TRUE(file.ok());
    EXPECT_EQ(file->kepler.size(), 1u);
    return file->warnings;
  };
  EXPECT_THAT(warnings_of("> EPH G01 LNAV\n" + record(sample_ephemeris(3, kFileToe), true)),
              ElementsAre("brd4.rnx:4: satellite \"G03\", expected G01; skipped"));
  EXPECT_THAT(
      warnings_of("> EPH G?? LNAV\nG01\n"),
      ElementsAre("brd4.rnx:3: record \"> EPH G?? LNAV\", expected kind, satellite and message, for example \"> "
                  "EPH G01 LNAV\", and lines of data; skipped"));
  EXPECT_THAT(warnings_of("> ION G12 LNAV\n    2023 03 12 00 08 54\n"),
              ElementsAre("brd4.rnx:4: G12: the record has 1 lines, expected 3; skipped"));
  EXPECT_THAT(
      warnings_of("garbage\n"),
      ElementsAre("brd4.rnx:3: a line that belongs to no record, expected a line that starts with \">\"; skipped"));
}

TEST(Klobuchar, TheLastGivenBeforeTheTime) {
  NavigationData data;
  const auto add = [&](GnssSystem system, double hours, double alpha) {
    data.klobuchar.push_back({system, kFileToe + 3600.0 * hours, {{alpha, 0, 0, 0}, {}}});
  };
  add(GnssSystem::kGps, 2.0, 2.0);
  add(GnssSystem::kGps, 0.0, 1.0);
  add(GnssSystem::kBeidou, 1.0, 9.0);
  const auto at = [&](double hours) {
    return data.klobuchar_at(GnssSystem::kGps, kFileToe + 3600.0 * hours)->alpha[0];
  };
  EXPECT_EQ(at(-1.0), 1.0);  // before all: the first
  EXPECT_EQ(at(1.9), 1.0);
  EXPECT_EQ(at(2.0), 2.0);
  EXPECT_EQ(at(99.0), 2.0);
}

// RINEX 2 writes years with two digits, and weeks that some programs roll over at 1024: both sides of every change.
TEST(NavigationExtremes, YearsAndWeeks) {
  for (const GpsTime toe :
       {GpsTime::from_calendar(1999, 12, 31, 22, 0, 0.0), GpsTime::from_calendar(2000, 1, 1, 0, 0, 0.0),
        GpsTime::from_calendar(1999, 8, 22, 0, 0, 0.0),  // week 1024
        GpsTime::from_calendar(2019, 4, 6, 22, 0, 0.0),  // last of week 2047
        GpsTime::from_calendar(2019, 4, 7, 0, 0, 0.0), GpsTime::from_calendar(1980, 1, 7, 0, 0, 0.0),
        GpsTime::from_calendar(2079, 12, 31, 0, 0, 0.0)}) {
    std::string text = header(false) + record(sample_ephemeris(1, toe), false);
    const std::string week = fortran(toe.week()), rolled = fortran(toe.week() % 1024);
    text.replace(text.find(week), week.size(), rolled);
    const auto file = parse_navigation_file(text, "brdc.n");
    ASSERT_TRUE(file.ok()) << file.error().str();
    EXPECT_EQ(file->kepler.front().toe, toe);
    EXPECT_EQ(file->kepler.front().toc, toe);
  }
}

// The clock's epoch on Saturday evening, toe on Sunday 0 h: the record belongs to the new week.
TEST(NavigationExtremes, ToeAcrossTheWeek) {
  const GpsTime sunday = GpsTime::from_week_sow(2254, 0.0);
  KeplerEphemeris r = sample_ephemeris(1, sunday);
  r.toc = sunday - 7200.0;
  const auto file = parse_navigation_file(header(true) + record(r, true), "brdc.rnx");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->kepler.front().toe, sunday);
  EXPECT_EQ(file->kepler.front().toc, sunday - 7200.0);
  EXPECT_EQ(file->kepler.front().transmitted, std::optional(sunday - 3600.0));  // written as -3600 s
}

// A day's boundary inside a fit interval: two daily files together give one smooth orbit.
TEST(NavigationExtremes, TwoDaysTogether) {
  const GpsTime midnight = GpsTime::from_calendar(2023, 3, 13, 0, 0, 0.0);
  auto first = parse_navigation_file(header(true) + record(sample_ephemeris(1, midnight - 7200.0), true), "one.rnx");
  auto second = parse_navigation_file(header(true) + record(sample_ephemeris(2, midnight + 7200.0), true), "two.rnx");
  ASSERT_TRUE(first.ok() && second.ok());
  NavigationData all = *first;
  all.append(*second);
  EXPECT_EQ(all.names(), "one.rnx, two.rnx");
  EXPECT_EQ(all.klobuchar.size(), 2u);
  const auto constellation = make_broadcast(all);
  EXPECT_TRUE(constellation->state({GnssSystem::kGps, 1}, midnight).has_value());
  EXPECT_TRUE(constellation->state({GnssSystem::kGps, 2}, midnight).has_value());
  EXPECT_FALSE(constellation->state({GnssSystem::kGps, 1}, midnight + 1.0).has_value());
}

// Another satellite's orbit under this one's number, between records that agree.
TEST(Contradictions, OneAgainstItsNeighbours) {
  std::vector<KeplerEphemeris> records;
  for (int k = 0; k < 5; ++k) {
    KeplerEphemeris r = sample_ephemeris(1, kFileToe + 7200.0 * k);
    // The same ellipse, its mean anomaly and node carried on to each toe.
    const double a_m = r.sqrt_a * r.sqrt_a, dt_s = 7200.0 * k;
    r.m0_rad += (std::sqrt(3.986005e14 / (a_m * a_m * a_m)) + r.delta_n_rad_s) * dt_s;
    r.omega0_rad += r.omega_dot_rad_s * dt_s;
    r.i0_rad += r.idot_rad_s * dt_s;
    records.push_back(r);
  }
  EXPECT_TRUE(contradictions(records).empty());
  auto wrong = records;
  wrong[2].m0_rad += 0.5;
  const auto found = contradictions(wrong);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].index, 2u);
  EXPECT_GT(found[0].distance_m, 1e7);
  wrong[2].health = 63;  // not used anyway
  EXPECT_TRUE(contradictions(wrong).empty());
  // A manoeuvre: two before, three after; nobody is alone.
  auto moved = records;
  for (std::size_t k = 2; k < 5; ++k) moved[k].m0_rad += 0.01;
  EXPECT_TRUE(contradictions(moved).empty());
  // Two that disagree: nobody can tell which is wrong.
  EXPECT_TRUE(contradictions({records[0], wrong[2]}).empty());
}

// A number that overflows in the orbit's evaluation is a damaged record, not an orbit and not a crash.
TEST(NavigationExtremes, NumbersThatNoMessageCanHoldWordForWord) {
  const std::string good = record(sample_ephemeris(2, kFileToe), true);
  const auto warning = [&](void (*change)(KeplerEphemeris&)) {
    KeplerEphemeris r = sample_ephemeris(1, kFileToe);
    change(r);
    const auto file = parse_navigation_file(header(true) + record(r, true) + good, "brdc.rnx");
    EXPECT_TRUE(file.ok());
    EXPECT_EQ(file->kepler.size(), 1u);
    return file->warnings.empty() ? "" : file->warnings.front();
  };
  EXPECT_EQ(warning([](auto& r) { r.delta_n_rad_s = 2.0; }),
            "brdc.rnx:7: G01: delta n = 2, expected at most 1e-06; skipped");
  EXPECT_EQ(warning([](auto& r) { r.omega_dot_rad_s = -3.0; }),
            "brdc.rnx:10: G01: OMEGA DOT = -3, expected at most 1e-06; skipped");
  EXPECT_EQ(warning([](auto& r) { r.crs_m = 1e9; }),
            "brdc.rnx:7: G01: Crs = 1000000000, expected at most 32768.5; skipped");
  EXPECT_EQ(warning([](auto& r) { r.cus_rad = 0.01; }), "brdc.rnx:8: G01: Cus = 0.01, expected at most 0.001; skipped");
  EXPECT_EQ(warning([](auto& r) { r.m0_rad = 11.0; }), "brdc.rnx:7: G01: M0 = 11, expected at most 10; skipped");
  EXPECT_EQ(warning([](auto& r) { r.af1 = 0.25; }), "brdc.rnx:6: G01: af1 = 0.25, expected less than 1e-7; skipped");
  EXPECT_EQ(warning([](auto& r) { r.sqrt_a = 1500.0; }).substr(0, 54),
            "brdc.rnx:7: G01: distance from the Earth's centre = 22");
}

TEST(NavigationExtremes, SurvivesDamage) {
  for (const std::string& good : {rinex4_text(), testing::navigation_text(kFileToe, 3, 2, true)}) {
    const auto read = [](const std::string& bad) {
      const auto file = parse_navigation_file(bad, "damaged.rnx");
      if (!file.ok()) {
        EXPECT_GT(file.error().line, 0);
        return;
      }
      const auto constellation = make_broadcast(*file);
      for (const SatelliteId sv : constellation->satellites())
        for (const double s : {-3600.0, 0.0, 1800.0, 7200.0})
          if (const auto state = constellation->state(sv, kFileToe + s)) {
            // A place and a clock that a receiver can work with, whatever the file says.
            EXPECT_LT(state->p_E.norm(), 2e8);
            EXPECT_LT(state->v_E.norm(), 2e5);
            EXPECT_LT(std::abs(state->clock_s), 1.1);
            EXPECT_LT(std::abs(state->clock_rate), 1e-6);
            transmission_from_pseudorange(*constellation, sv, kFileToe + s, 2e7);
          }
      const auto k = file->klobuchar_at(GnssSystem::kGps, kFileToe);
      if (k) {
        EXPECT_LT(klobuchar_delay_m(*k, kFileToe, 0.5, 0.5, 0.5, 0.5), 1e9);
      }
    };
    testing::for_each_truncation(good, read);
    testing::for_each_damage(good, 500, 20, read);
    testing::for_each_extreme_number(good, read);
  }
}

}  // namespace
}  // namespace canyon::gnss
