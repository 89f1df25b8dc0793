#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/nmea/nmea_reader.h"
#include "canyon/gnss/nmea/nmea_writer.h"
#include "canyon/gnss/nmea/sentence.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

NmeaEpoch epoch_at(const Geodetic& g) {
  NmeaEpoch e;
  e.fix.t = GpsTime::from_calendar(2010, 7, 1, 13, 0, 15.0 + 0.25);  // GPS is 15 s ahead of UTC
  e.fix.status = FixStatus::kDifferential;
  e.fix.p_A_E = ecef_from_geodetic(g);
  e.fix.v_A_E = rotation_E_from_enu(g) * Eigen::Vector3d(3.0, 4.0, 0.0);
  e.fix.satellites = 5;
  e.fix.dop = {3.0, 2.5, 1.25, 2.1651, 1.6};
  e.undulation_m = -28.5;
  const auto add = [&](GnssSystem system, int prn, double cn0, bool used) {
    e.satellites.push_back({{system, static_cast<std::uint8_t>(prn)}, 0.5, 3.0, cn0, used});
  };
  for (int prn = 1; prn <= 5; ++prn) add(GnssSystem::kGps, prn, 40.0 + prn, prn < 4);
  add(GnssSystem::kGlonass, 3, 38.4, true);
  add(GnssSystem::kGalileo, 11, 44.6, true);
  add(GnssSystem::kBeidou, 19, kNaN, false);
  return e;
}

TEST(NmeaSentence, ChecksumOfTheStandardsExample) {
  // The well-known GGA of NMEA 0183's own documentation.
  EXPECT_EQ(nmea_sentence("GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,"),
            "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n");
  ASSERT_TRUE(nmea_fields("$GPGLL,,,*00").has_value() == false);
  const auto fields = nmea_fields("$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r");
  ASSERT_TRUE(fields.has_value());
  EXPECT_EQ(fields->size(), 15U);
  EXPECT_EQ(fields->back(), "");
}

TEST(NmeaWriter, SentencesWordForWord) {
  const std::string text = nmea_text(epoch_at({32.35 * kDegree, -90.88 * kDegree, 61.5}));
  EXPECT_THAT(text, HasSubstr("GNGGA,130000.25,3221.0000000,N,09052.8000000,W,2,05,1.25,90.000,M,-28.500,M,,*"));
  // 5 m/s = 9.719 knots; atan2(3, 4) = 36.87 deg.
  EXPECT_THAT(text, HasSubstr("GNRMC,130000.25,A,3221.0000000,N,09052.8000000,W,9.719,36.87,010710,,,D,V*"));
  EXPECT_THAT(text, HasSubstr("GNGSA,A,3,01,02,03,,,,,,,,,,2.50,1.25,2.17,1*"));
  EXPECT_THAT(text, HasSubstr("GNGSA,A,3,67,,,,,,,,,,,,2.50,1.25,2.17,2*"));
  EXPECT_THAT(text, HasSubstr("GPGSV,2,1,05,01,29,172,41,02,29,172,42,03,29,172,43,04,29,172,44,1*"));
  EXPECT_THAT(text, HasSubstr("GPGSV,2,2,05,05,29,172,45,1*"));
  EXPECT_THAT(text, HasSubstr("GBGSV,1,1,01,19,29,172,,1*"));
}

TEST(NmeaWriter, NoFixIsVoid) {
  NmeaEpoch e = epoch_at({});
  e.fix.status = FixStatus::kNone;
  for (auto& s : e.satellites) s.used = false;
  const std::string text = nmea_text(e);
  EXPECT_THAT(text, HasSubstr("GPGGA,130000.25,,,,,0,00,,,M,,M,,*"));
  EXPECT_THAT(text, HasSubstr("GPRMC,130000.25,V,,,,,,,010710,,,N,V*"));
  EXPECT_THAT(text, HasSubstr("GPGSA,A,1,,,,,,,,,,,,,,,,1*"));
}

// Written and read again: time to 10 ms, position to the 0.2 mm of seven decimals of a minute, height to 1 mm; poles,
// date line, and angles that round up to a whole degree.
TEST(NmeaRoundTrip, PlacesAndTimes) {
  const double places[][3] = {{32.35, -90.88, 61.5},
                              {-33.999999999, 179.999999999, -400.0},
                              {89.9999, -179.9999, 20000.0},
                              {0.0, 0.0, 0.0},
                              {-90.0, 0.0, 10.0},
                              {52.5, 13.4, 80.0}};
  for (const auto& p : places) {
    const NmeaEpoch e = epoch_at({p[0] * kDegree, p[1] * kDegree, p[2]});
    const auto file = parse_nmea(nmea_text(e), "twin.nmea");
    ASSERT_TRUE(file.ok()) << file.error().str();
    ASSERT_EQ(file->records.size(), 1U);
    const NmeaRecord& r = file->records.front();
    EXPECT_EQ(r.t, e.fix.t);
    EXPECT_EQ(r.quality, 2);
    EXPECT_NEAR((ecef_from_geodetic(r.place) - e.fix.p_A_E).norm(), 0.0, 1.5e-3);
    EXPECT_NEAR(r.speed_m_s, 5.0, 3e-4);  // three decimals of a knot
    EXPECT_EQ(r.satellites, 5);
    EXPECT_EQ(file->damaged_lines, 0);
  }
}

// Through the leap second at the end of 2016: UTC says 59, 60, 00, and a reader makes GPS time of it again.
TEST(NmeaRoundTrip, LeapSecond) {
  const GpsTime new_year = GpsTime::from_calendar(2017, 1, 1, 0, 0, 18.0);
  std::string log;
  const char* const labels[] = {"235959.00", "235960.00", "000000.00", "000001.00"};
  for (int k = 0; k < 4; ++k) {
    NmeaEpoch e;
    e.fix.t = new_year + (k - 2.0);
    e.fix.status = FixStatus::kSingle;
    e.fix.p_A_E = ecef_from_geodetic({0.5, 0.2, 100.0});
    const std::string text = nmea_text(e);
    EXPECT_THAT(text, HasSubstr(std::string("$GPGGA,") + labels[k])) << text;
    EXPECT_THAT(text, HasSubstr(k < 2 ? ",311216," : ",010117,")) << text;
    log += text;
  }
  const auto file = parse_nmea(log, "log.nmea");
  ASSERT_TRUE(file.ok());
  ASSERT_EQ(file->records.size(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(file->records[static_cast<std::size_t>(k)].t, new_year + (k - 2.0)) << k;
}

TEST(NmeaReader, DamagedLinesAreCountedAndNamed) {
  std::string text = nmea_text(epoch_at({0.5, 0.5, 10.0}));
  text += "$GPGGA,130001.00,9999.0,N,00000.0,E,1,05,1.0,1.0,M,0.0,M,,*00\r\n";
  text += nmea_sentence("GPGGA,130002.00,xx,N,00000.0,E,1,05,1.0,1.0,M,0.0,M,,");
  const auto file = parse_nmea(text, "log.nmea");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->damaged_lines, 2);
  const std::size_t lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  EXPECT_EQ(file->warnings[0],
            "log.nmea:" + std::to_string(lines - 1) + ": NMEA sentence without a right checksum: skipped");
  EXPECT_EQ(file->warnings[1],
            "log.nmea:" + std::to_string(lines) + ": NMEA sentence with a field that does not parse: skipped");
}

TEST(NmeaReader, SomethingElseIsAnError) {
  for (const std::string& text :
       {std::string(), std::string("\0\1\2binary", 9), std::string("     2.11   NAVIGATION DATA\n")}) {
    const auto file = parse_nmea(text, "x.nmea");
    ASSERT_FALSE(file.ok());
    EXPECT_EQ(file.error().str(), "x.nmea: no GGA or RMC sentence in it, expected an NMEA 0183 log");
  }
}

// Mountain View, 2020-02-07: a u-blox F9K against a NovAtel SPAN; the figures of its source are 0.49 m (50 %) and
// 0.83 m (95 %) horizontally.
TEST(NmeaReal, FusedReceiverAgainstItsReference) {
  CANYON_REAL_DATA(log, "gnss/google_mtv_2020/MTV.Local1.ublox-F9K.20200206-181434.nmea.gz");
  CANYON_REAL_DATA(reference, "gnss/google_mtv_2020/MTV.Local1.SPAN.20200206-181434.gga");
  const auto receiver = read_nmea_file(log);
  // The reference's RMC sentences were shortened without a new checksum: its GGA alone count, and the date is given.
  const auto truth = read_nmea_file(reference, GpsTime::from_calendar(2020, 2, 7, 0, 0, 0.0));
  ASSERT_TRUE(receiver.ok()) << receiver.error().str();
  ASSERT_TRUE(truth.ok()) << truth.error().str();
  std::vector<double> errors;
  std::size_t j = 0;
  for (const NmeaRecord& r : receiver->records) {
    while (j < truth->records.size() && truth->records[j].t < r.t) ++j;
    if (j == truth->records.size() || truth->records[j].t != r.t || r.quality == 0) continue;
    const Geodetic& g = truth->records[j].place;
    const Eigen::Vector3d d =
        rotation_E_from_enu(g).transpose() * (ecef_from_geodetic(r.place) - ecef_from_geodetic(g));
    errors.push_back(d.head<2>().norm());
  }
  ASSERT_GT(errors.size(), 1000U);
  std::sort(errors.begin(), errors.end());
  EXPECT_NEAR(errors[errors.size() / 2], 0.49, 0.05);
  EXPECT_NEAR(errors[errors.size() * 95 / 100], 0.83, 0.05);
}

}  // namespace
}  // namespace canyon::gnss
