#include "canyon/gnss/satellites/ephemerides/glonass_ephemeris.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/tests/gnss/rinex/nav_text.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using ::testing::ElementsAre;
using testing::fortran;
using testing::header_line;

const GpsTime kTb = GpsTime::from_calendar(2016, 6, 6, 0, 15, 17.0);  // 00:15 UTC

GlonassEphemeris sample() {
  GlonassEphemeris r;
  r.sv = {GnssSystem::kGlonass, 1};
  r.toe = kTb;
  r.p_E = {-6553.42626954e3, 22609.1289062e3, 9851.01660156e3};
  r.v_E = {-518.354415894, 1249.16648865, -3213.09471130};
  r.a_E = {-9.31322574616e-7, -2.79396772385e-6, 0.0};
  r.clock_s = -1.42809003591e-4;
  r.clock_rate = 1.8e-12;
  r.frequency_channel = 1;
  return r;
}

TEST(GlonassEphemeris, AtTbItIsTheRecord) {
  const SatelliteState s = sample().at(kTb);
  EXPECT_EQ(s.p_E, sample().p_E);
  EXPECT_EQ(s.v_E, sample().v_E);
  EXPECT_EQ(s.clock_s, sample().clock_s);
  EXPECT_EQ(s.frequency_channel, 1);
}

// Acceleration and jerk of the orbit leave h^2 of 1 s in central differences: jerk / 24 = 4e-5 m/s^3 / 24, 1 ns of time
// 3e-6 m.
TEST(GlonassEphemeris, VelocityIsTheDerivative) {
  const GlonassEphemeris r = sample();
  for (const double dt_s : {-900.0, -61.0, 0.0, 59.9, 60.0, 60.1, 777.0, 900.0}) {
    const SatelliteState before = r.at(kTb + (dt_s - 0.5)), after = r.at(kTb + (dt_s + 0.5)), now = r.at(kTb + dt_s);
    EXPECT_LT((after.p_E - before.p_E - now.v_E).norm(), 1e-5) << dt_s;
    EXPECT_NEAR(after.clock_s - before.clock_s, now.clock_rate, 1e-18);
  }
}

// Fourth order: one step of 60 s against two of 30 s differ by 15/16 of the error of one. Here: forth and back again.
TEST(GlonassEphemeris, IntegratesThereAndBack) {
  GlonassEphemeris there = sample();
  const SatelliteState end = there.at(kTb + 900.0);
  there.p_E = end.p_E;
  there.v_E = end.v_E;
  there.toe = kTb + 900.0;
  const SatelliteState back = there.at(kTb);
  EXPECT_LT((back.p_E - sample().p_E).norm(), 1e-4);
  EXPECT_LT((back.v_E - sample().v_E).norm(), 1e-7);
}

// Without Sun, Moon and J2's change of it the energy in inertial space is conserved; with J2 its potential joins in.
TEST(GlonassEphemeris, EnergyIsConserved) {
  GlonassEphemeris r = sample();
  r.a_E.setZero();
  const SystemConstants& k = constants_of(GnssSystem::kGlonass);
  const auto energy = [&](const SatelliteState& s) {
    const Eigen::Vector3d v = s.v_E + k.earth_rate_rad_s * Eigen::Vector3d::UnitZ().cross(s.p_E);
    const double radius = s.p_E.norm(), sin_lat = s.p_E.z() / radius;
    const double j2 = 1082625.75e-9 * std::pow(6378136.0 / radius, 2) * (1.5 * sin_lat * sin_lat - 0.5);
    return 0.5 * v.squaredNorm() - k.mu_m3_s2 / radius * (1.0 - j2);
  };
  const double before = energy(r.at(kTb));
  for (const double dt_s : {-1200.0, 300.0, 1200.0})
    EXPECT_NEAR(energy(r.at(kTb + dt_s)), before, 1e-11 * -before) << dt_s;
}

TEST(GlonassEphemeris, ValidityAndDelay) {
  GlonassEphemeris r = sample();
  r.delta_tau_s = 8e-9;
  NavigationData data;
  data.glonass.push_back(r);
  const auto constellation = make_broadcast(data);
  EXPECT_TRUE(constellation->state(r.sv, kTb + 1200.0).has_value());
  EXPECT_FALSE(constellation->state(r.sv, kTb + 1200.001).has_value());
  EXPECT_EQ(constellation->state(r.sv, kTb)->group_delay_s[2], 8e-9);
  data.glonass.front().health = 1;
  EXPECT_FALSE(make_broadcast(data)->state(r.sv, kTb).has_value());
}

TEST(UtcToGps, LeapSeconds) {
  const auto gps = [](int y, int mo, int d, int h, int mi, double s) {
    const GpsTime utc = GpsTime::from_calendar(y, mo, d, h, mi, s);
    return gps_time_of_utc(utc) - utc;
  };
  EXPECT_EQ(gps(2016, 12, 31, 23, 45, 0.0), 17.0);
  EXPECT_EQ(gps(2016, 12, 31, 23, 59, 59.0), 17.0);
  EXPECT_EQ(gps(2017, 1, 1, 0, 0, 0.0), 18.0);
  EXPECT_EQ(gps(2017, 1, 1, 0, 15, 0.0), 18.0);
  EXPECT_EQ(gps(2008, 12, 31, 23, 45, 0.0), 14.0);
  EXPECT_EQ(gps(1980, 1, 6, 0, 0, 0.0), 0.0);
}

std::string number(double value) {
  return fortran(value);
}

/// A GLONASS record of the sample; `utc_day` shifts its date. RINEX 2 or 3, the latter with the fifth line of 3.05.
std::string record(int version, const std::string& epoch) {
  const GlonassEphemeris r = sample();
  const std::string indent(version == 2 ? 3 : 4, ' ');
  std::string out = epoch + number(r.clock_s) + number(r.clock_rate) + number(900.0) + "\n";
  const double last[] = {0.0, 1.0, 0.0};
  for (Eigen::Index i = 0; i < 3; ++i)
    out +=
        indent + number(1e-3 * r.p_E[i]) + number(1e-3 * r.v_E[i]) + number(1e-3 * r.a_E[i]) + number(last[i]) + "\n";
  if (version == 3) out += indent + number(0.0) + number(8e-9) + number(2.0) + number(3.0) + "\n";
  return out;
}

TEST(GlonassRecord, Rinex2And3GiveEveryFieldBack) {
  const std::string head2 = header_line("     2.01           GLONASS NAV DATA", "RINEX VERSION / TYPE") +
                            header_line("", "END OF HEADER"),
                    head3 = header_line("     3.05           N: GNSS NAV DATA    R: GLONASS", "RINEX VERSION / TYPE") +
                            header_line("", "END OF HEADER");
  for (const int version : {2, 3}) {
    const auto file = parse_navigation_file(
        version == 2 ? head2 + record(2, " 1 16  6  6  0 15  0.0") : head3 + record(3, "R01 2016 06 06 00 15 00"),
        "brdc.16g");
    ASSERT_TRUE(file.ok()) << file.error().str();
    EXPECT_TRUE(file->warnings.empty());
    ASSERT_EQ(file->glonass.size(), 1u);
    const GlonassEphemeris &got = file->glonass.front(), want = sample();
    EXPECT_EQ(got.sv, want.sv);
    EXPECT_EQ(got.toe, want.toe);  // UTC + 17 s
    EXPECT_LT((got.p_E - want.p_E).norm(), 1e-4);
    EXPECT_LT((got.v_E - want.v_E).norm(), 1e-8);
    EXPECT_LT((got.a_E - want.a_E).norm(), 1e-17);
    EXPECT_NEAR(got.clock_s, want.clock_s, 1e-16);
    EXPECT_EQ(got.frequency_channel, 1);
    EXPECT_NEAR(got.delta_tau_s, version == 3 ? 8e-9 : 0.0, 1e-20);
    EXPECT_TRUE(got.healthy());
  }
}

TEST(GlonassRecord, DamagedRecordsAreSkippedWithTheirLine) {
  const std::string head = header_line("     2.01           GLONASS NAV DATA", "RINEX VERSION / TYPE") +
                           header_line("", "END OF HEADER"),
                    good = record(2, " 2 16  6  6  0 15  0.0");
  const auto warnings_of = [&](std::string bad, const std::string& from, const std::string& to) {
    bad.replace(bad.find(from), from.size(), to);
    const auto file = parse_navigation_file(head + bad + good, "brdc.16g");
    EXPECT_TRUE(file.ok());
    EXPECT_EQ(file->glonass.size(), 1u);
    return file->warnings;
  };
  const std::string one = record(2, " 1 16  6  6  0 15  0.0");
  EXPECT_THAT(warnings_of(one, " 1 16  6  6", " 1 16 16  6"),
              ElementsAre("brdc.16g:3: R01: its epoch cannot be read, expected year month day hour minute second; "
                          "skipped"));
  EXPECT_THAT(warnings_of(one, "2.260912890620D+04", "2.260912890620D+05"),
              ElementsAre("brdc.16g:4: R01: distance from the Earth's centre = 226400664.56101966 m, expected 24000 to "
                          "27000 km (GLONASS: 25500); skipped"));
  EXPECT_THAT(warnings_of(one, " 1.000000000000D+00", " 7.700000000000D+01"),
              ElementsAre("brdc.16g:5: R01: frequency number = 77, expected -7 to 13; skipped"));
}

// Each record integrated to the middle between it and the next: the ICD promises metres (measured over 2,700 pairs: RMS
// 1.1 m, 3.7 m at most; 0.003 m/s; clocks 0.2 to 0.3 m in the median).
TEST(GlonassEphemeris, NeighbouringRealRecordsAgreeInTheMiddle) {
  CANYON_REAL_DATA(old_file, "gnss/urban_berlin/brdc1580.16g");
  CANYON_REAL_DATA(new_file, "gnss/rinex4/BRD400DLR_S_20230710000_01D_MN.rnx.gz");
  for (const std::string& path : {old_file, new_file}) {
    const auto data = read_navigation_file(path);
    ASSERT_TRUE(data.ok()) << data.error().str();
    std::map<SatelliteId, std::vector<GlonassEphemeris>> by_satellite;
    for (const auto& r : data->glonass) by_satellite[r.sv].push_back(r);
    std::vector<double> away_m;
    for (auto& [sv, records] : by_satellite) {
      std::sort(records.begin(), records.end(), [](const auto& a, const auto& b) { return a.toe < b.toe; });
      for (std::size_t i = 1; i < records.size(); ++i) {
        if (std::abs(records[i].toe - records[i - 1].toe - 1800.0) > 1.0) continue;
        const GpsTime middle = records[i].toe - 900.0;
        const SatelliteState a = records[i - 1].at(middle), b = records[i].at(middle);
        away_m.push_back((a.p_E - b.p_E).norm());
        EXPECT_LT((a.v_E - b.v_E).norm(), 0.02) << sv.str();
      }
    }
    ASSERT_GT(away_m.size(), 1000u);
    double sum = 0.0;
    for (const double m : away_m) sum += m * m;
    EXPECT_LT(std::sqrt(sum / static_cast<double>(away_m.size())), 1.5);
    EXPECT_LT(*std::max_element(away_m.begin(), away_m.end()), 6.0);
  }
}

}  // namespace
}  // namespace canyon::gnss
