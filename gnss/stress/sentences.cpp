// NMEA 0183 sentences word by word, and logs that are damaged, begin late or pass midnight.
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <tuple>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/nmea/nmea_reader.h"
#include "canyon/gnss/nmea/nmea_writer.h"
#include "canyon/gnss/nmea/sentence.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;

/// With the exclusive or of its characters, as the standard has it.
std::string summed(const std::string& body) {
  int sum = 0;
  for (const char c : body) sum ^= c;
  char tail[8];
  std::snprintf(tail, sizeof tail, "*%02X\r\n", static_cast<unsigned>(sum));
  return "$" + body + tail;
}

NmeaEpoch some_epoch() {
  NmeaEpoch e;
  const Geodetic at{48.5 * kDegree, -11.25 * kDegree, 545.5};
  e.fix.t = GpsTime::from_calendar(2010, 7, 1, 13, 0, 15.004);  // 15 s ahead of UTC
  e.fix.status = FixStatus::kSingle;
  e.fix.p_A_E = ecef_from_geodetic(at);
  e.fix.v_A_E = rotation_E_from_enu(at) * Vector3d(3.0, 4.0, -1.0);
  e.fix.satellites = 8;
  e.fix.dop.hdop = 0.954, e.fix.dop.pdop = 1.755, e.fix.dop.vdop = 1.2;
  e.undulation_m = 45.5;
  return e;
}

/// Every sentence of a fix, of a differential one and of none, letter by letter; place and time as they are told.
StressFigure sentences_written() {
  int wrong = 0;
  const auto is = [&](const NmeaEpoch& e, const std::vector<std::string>& bodies) {
    std::string expected;
    for (const std::string& body : bodies) expected += summed(body);
    wrong += nmea_text(e) == expected ? 0 : 1;
  };
  NmeaEpoch e = some_epoch();
  using enum GnssSystem;
  for (const auto& [system, prn, elevation_deg, azimuth_deg, cn0, used] : {std::tuple{kGps, 5, 30.4, 100.6, 45.5, true},
                                                                           {kGps, 12, 9.6, 359.6, kNaN, false},
                                                                           {kSbas, 20, 25.0, 180.0, 38.0, true},
                                                                           {kGlonass, 3, 61.0, 7.0, 51.4, true},
                                                                           {kGalileo, 7, 89.7, 0.4, 130.0, true},
                                                                           {kBeidou, 33, 45.0, 270.0, -3.0, false},
                                                                           {kQzss, 1, 12.0, 45.0, 40.0, false},
                                                                           {kGps, 31, 5.0, 50.0, 33.0, true},
                                                                           {kGps, 9, 15.0, 60.0, 33.3, true}})
    e.satellites.push_back(
        {{system, static_cast<std::uint8_t>(prn)}, elevation_deg * kDegree, azimuth_deg * kDegree, cn0, used});
  const std::string place = "4830.0000000,N,01115.0000000,W";
  const std::vector<std::string> sky{"GPGSV,2,1,05,05,30,101,46,12,10,000,,33,25,180,38,31,05,050,33,1",
                                     "GPGSV,2,2,05,09,15,060,33,1",
                                     "GLGSV,1,1,01,67,61,007,51,1",
                                     "GAGSV,1,1,01,07,90,000,99,7",
                                     "GBGSV,1,1,01,33,45,270,00,1",
                                     "GQGSV,1,1,01,01,12,045,40,1"};
  const auto with_sky = [&](std::vector<std::string> bodies) {
    bodies.insert(bodies.end(), sky.begin(), sky.end());
    return bodies;
  };
  const std::vector<std::string> used{"GNGSA,A,3,05,33,31,09,,,,,,,,,1.75,0.95,1.20,1",
                                      "GNGSA,A,3,67,,,,,,,,,,,,1.75,0.95,1.20,2",
                                      "GNGSA,A,3,07,,,,,,,,,,,,1.75,0.95,1.20,3"};
  e.fix.dop.pdop = 1.75;
  is(e, with_sky({"GNGGA,130000.00," + place + ",1,08,0.95,500.000,M,45.500,M,,",
                  "GNRMC,130000.00,A," + place + ",9.719,36.87,010710,,,A,V", used[0], used[1], used[2]}));
  e.fix.status = FixStatus::kDifferential, e.fix.t = e.fix.t + 0.002;
  e.fix.v_A_E = rotation_E_from_enu({48.5 * kDegree, -11.25 * kDegree, 0.0}) * Vector3d(-0.05, 0.05, 9.0);
  is(e, with_sky({"GNGGA,130000.01," + place + ",2,08,0.95,500.000,M,45.500,M,,",
                  "GNRMC,130000.01,A," + place + ",0.137,,010710,,,D,V", used[0], used[1], used[2]}));
  e.fix.status = FixStatus::kNone, e.satellites.clear();
  is(e, {"GPGGA,130000.01,,,,,0,00,,,M,,M,,", "GPRMC,130000.01,V,,,,,,,010710,,,N,V", "GPGSA,A,1,,,,,,,,,,,,,,,,1"});
  // One system alone is its own talker; the thirteenth satellite takes another sentence, the fifth in view another.
  NmeaEpoch many = some_epoch();
  many.fix.v_A_E.setConstant(kNaN), many.fix.dop = {};
  for (int k = 1; k <= 13; ++k)
    many.satellites.push_back({{kGalileo, static_cast<std::uint8_t>(k)}, 0.0, 0.0, kNaN, true});
  is(many, {"GAGGA,130000.00," + place + ",1,08,,500.000,M,45.500,M,,",
            "GARMC,130000.00,A," + place + ",,,010710,,,A,V", "GAGSA,A,3,01,02,03,04,05,06,07,08,09,10,11,12,,,,3",
            "GAGSA,A,3,13,,,,,,,,,,,,,,,3", "GAGSV,4,1,13,01,00,000,,02,00,000,,03,00,000,,04,00,000,,7",
            "GAGSV,4,2,13,05,00,000,,06,00,000,,07,00,000,,08,00,000,,7",
            "GAGSV,4,3,13,09,00,000,,10,00,000,,11,00,000,,12,00,000,,7", "GAGSV,4,4,13,13,00,000,,7"});
  wrong += nmea_sentence("GPZDA,1") == summed("GPZDA,1") ? 0 : 1;
  const std::string line = summed("GPZDA,,a,");
  const auto fields = nmea_fields(line);
  wrong +=
      fields && fields->size() == 4 && (*fields)[0] == "GPZDA" && (*fields)[1].empty() && (*fields)[2] == "a" ? 0 : 1;
  std::string lower = summed("GPGGA,j");
  for (std::size_t k = lower.size() - 4; k < lower.size(); ++k)
    lower[k] = static_cast<char>(std::tolower(static_cast<unsigned char>(lower[k])));
  wrong += nmea_fields(lower) && !nmea_fields("$GPGGA,1") && !nmea_fields("$*00x") && !nmea_fields("GPGGA*56") ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// A log as receivers write it: each figure of its records, lines that are damaged, epochs before any date, midnight
/// that comes with a sentence without a date.
StressFigure logs_read() {
  int wrong = 0;
  const std::string gga = "GPGGA,130000.00,4830.0000000,N,01115.0000000,W,2,08,0.95,500.000,M,45.500,M,,";
  const auto parsed = parse_nmea(
      summed("GPGGA,125959.00,4830.0,N,01115.0,W,1,08,,500,M,45.5,M,,") + "noise\n" + summed(gga) +
          summed("GPRMC,130000.00,A,4830.0,N,01115.0,W,36.0,90.0,010710,,,A,V") + summed("GPGSV,1,1,00") +
          "$GPGGA,1*00\r\n" + summed("GPGGA,130001.00,4830.0,X,01115.0,W,1,08,,500,M,45.5,M,,") +
          summed("GPGGA,130002.00,9030.0,N,01115.0,W,1,08,,500,M,45.5,M,,") +
          summed("GPRMC,130003.00,V,,,,,,,310210,,,N") +
          summed("GPGGA,240000.00,4830.0,N,01115.0,W,1,08,,500,M,45.5,M,,") + summed("GPGGA,,,,,,0,00,,,M,,M,,") +
          summed("GPGGA,130004.50,,,,,0,00,,,M,,M,,") +
          summed("GPRMC,130005.00,A,4830.0,N,01115.0,W,1.0,2.0,010710,,,A") +
          summed("GPGGA,235959.50,4830.0,S,17959.0,E,5,4,1.5,-3,M,,M,,") +
          summed("GPGGA,000000.50,4830.0,S,17959.0,E,4,4,1.5,-3,M,,M,,") + summed("GPZDA,000001.00,02,07,2010,00,00") +
          summed("GPGGA,000001.00,0000.6,N,00000.0,E,1,04,1,1,M,1,M,,"),
      "made.nmea");
  if (!parsed.ok() || parsed->records.size() != 7) return {stress::kInfinity, 0.0};
  const auto at = [&](std::size_t k, int day, int hour, int minute, double second, int quality) {
    wrong += parsed->records[k].t == GpsTime::from_calendar(2010, 7, day, hour, minute, second) + 15.0 &&
                     parsed->records[k].quality == quality
                 ? 0
                 : 1;
  };
  at(0, 1, 13, 0, 0.0, 2), at(1, 1, 13, 0, 3.0, 0), at(2, 1, 13, 0, 4.5, 0), at(3, 1, 13, 0, 5.0, 0);
  at(4, 1, 23, 59, 59.5, 5), at(5, 2, 0, 0, 0.5, 4), at(6, 2, 0, 0, 1.0, 1);
  const NmeaRecord &first = parsed->records[0], &south = parsed->records[4], &last = parsed->records[6];
  wrong += std::abs(first.place.lat_rad - 48.5 * kDegree) < 4.0 * kEpsilon && first.place.h_m == 545.5 ? 0 : 1;
  wrong += std::abs(first.place.lon_rad + 11.25 * kDegree) < 4.0 * kEpsilon && first.satellites == 8 ? 0 : 1;
  wrong += first.hdop == 0.95 && std::abs(first.speed_m_s - 36.0 * 1852.0 / 3600.0) < 1e-14 ? 0 : 1;
  wrong += std::abs(first.course_rad - 0.5 * kPi) < 4.0 * kEpsilon ? 0 : 1;
  wrong += std::abs(south.place.lat_rad + 48.5 * kDegree) < 4.0 * kEpsilon && south.place.h_m == -3.0 ? 0 : 1;
  wrong += std::abs(south.place.lon_rad - (179.0 + 59.0 / 60.0) * kDegree) < 4.0 * kEpsilon ? 0 : 1;
  wrong += std::abs(last.place.lat_rad - 0.01 * kDegree) < 4.0 * kEpsilon && std::isnan(last.speed_m_s) ? 0 : 1;
  const char* const told[] = {"made.nmea:6: NMEA sentence without a right checksum: skipped",
                              "made.nmea:7: NMEA sentence with a field that does not parse: skipped",
                              "made.nmea:8: NMEA sentence with a field that does not parse: skipped",
                              "made.nmea:9: NMEA sentence with a field that does not parse: skipped",
                              "made.nmea:10: NMEA sentence with a field that does not parse: skipped"};
  wrong += parsed->damaged_lines == 5 && parsed->warnings.size() == 5 ? 0 : 1;
  for (std::size_t k = 0; k < parsed->warnings.size() && k < 5; ++k) wrong += parsed->warnings[k] == told[k] ? 0 : 1;
  // A day that is told beside the log, for sentences without any.
  const auto dated = parse_nmea(summed(gga), "made.nmea", GpsTime::from_calendar(2017, 1, 1, 0, 0, 0.0));
  wrong +=
      dated.ok() && dated->records.size() == 1 && dated->records[0].t == GpsTime::from_calendar(2017, 1, 1, 13, 0, 18.0)
          ? 0
          : 1;
  const auto undated = parse_nmea(summed(gga), "made.nmea"), none = parse_nmea(summed("GPGSV,1"), "made.nmea");
  wrong += undated.ok() && undated->records.empty() ? 0 : 1;
  wrong +=
      !none.ok() && none.error().str() == "made.nmea: no GGA or RMC sentence in it, expected an NMEA 0183 log" ? 0 : 1;
  std::string damaged = summed(gga);
  for (int k = 0; k < 30; ++k) damaged += "$GPGGA*00\n";
  const auto many = parse_nmea(damaged, "made.nmea");
  wrong += many.ok() && many->damaged_lines == 30 && many->warnings.size() == 10 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> sentence_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "NMEA sentences as written and as read",
           "a satellite's number of the other system, a field too few, a day that ends an epoch early",
           "each sentence letter by letter, each record's figures, each damaged line: exact", "wrong"});
  rows.add("sentences/written", sentences_written).add("sentences/logs_read", logs_read);
  return rows.take();
}

}  // namespace canyon::gnss
