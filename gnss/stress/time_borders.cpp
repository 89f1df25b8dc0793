// Weeks, years and leap seconds in every reader and writer.
#include <array>
#include <cmath>
#include <limits>

#include "canyon/core/earth/earth.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/nmea/nmea_reader.h"
#include "canyon/gnss/nmea/nmea_writer.h"
#include "canyon/gnss/nmea/sentence.h"
#include "canyon/gnss/products/almanac_file.h"
#include "canyon/gnss/products/clock_file.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/rinex/navigation/navigation_writer.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/rinex/observation/observation_writer.h"
#include "canyon/gnss/rinex/record_fields.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// GPS times of the borders: weeks that a count of 10, 11 and 13 bits forgets, years, leap days, a week's end, and (in
/// GPS time) the midnights of UTC at which a second was put in.
std::vector<GpsTime> borders() {
  std::vector<GpsTime> out;
  for (const int week : {1024, 1356, 2047, 2048, 4096, 8191}) out.push_back(GpsTime::from_week_sow(week, 0.0));
  for (const int year : {1981, 1999, 2000, 2001, 2010, 2079, 2080, 2100, 2101})
    out.push_back(GpsTime::from_calendar(year, 1, 1, 0, 0, 0.0));
  for (const int year : {2000, 2016, 2100}) out.push_back(GpsTime::from_calendar(year, 3, 1, 0, 0, 0.0));
  struct Leap {
    int year, month, count;
  };
  for (const Leap& leap : {Leap{1982, 7, 2}, Leap{1999, 1, 13}, Leap{2009, 1, 15}, Leap{2012, 7, 16}, Leap{2015, 7, 17},
                           Leap{2017, 1, 18}})
    out.push_back(GpsTime::from_calendar(leap.year, leap.month, 1, 0, 0, leap.count));
  return out;
}

/// Whole seconds around each border.
std::vector<GpsTime> seconds_around() {
  std::vector<GpsTime> out;
  for (const GpsTime t : borders())
    for (const int s : {-7200, -2, -1, 0, 1, 2, 3600}) out.push_back(t + static_cast<double>(s));
  return out;
}

double apart_s(std::int64_t a_ns, std::int64_t b_ns) {
  return std::abs(static_cast<double>(a_ns - b_ns)) / 1e9;
}

KeplerEphemeris ephemeris(GnssSystem system, GpsTime t) {
  KeplerEphemeris r;
  r.sv = {system, 11};
  r.message = system == GnssSystem::kBeidou    ? NavigationMessage::kD1
              : system == GnssSystem::kGalileo ? NavigationMessage::kInav
                                               : NavigationMessage::kLnav;
  r.toe = r.toc = t;
  r.sqrt_a = 5153.6, r.e = 0.01, r.i0_rad = 0.96;
  r.accuracy_m = 2.0;
  return r;
}

/// Written as RINEX 3 and read again: the epochs come back to the nanosecond, the leap seconds of GLONASS's UTC
/// included.
StressFigure navigation(GnssSystem system) {
  StressFigure out;
  for (const GpsTime t : seconds_around()) {
    NavigationData data;
    data.files = {{"made.nav", 3.04}};
    if (system == GnssSystem::kGlonass) {
      // 23:59:60 UTC has no label of its own in RINEX; records come on the quarter of an hour.
      const GpsTime quarter{(t.ns - t.leap_seconds() * kNsPerSecond) / 900'000'000'000 * 900'000'000'000};
      GlonassEphemeris r;
      r.sv = {system, 11};
      r.toe = gps_time_of_utc(quarter);
      r.p_E = {7003e3, -12206e3, 21280e3}, r.v_E = {783.0, 2804.0, 1352.0};
      data.glonass.push_back(r);
    } else {
      data.kepler.push_back(ephemeris(system, t));
    }
    const auto text = navigation_file_text(data);
    const auto read = text.ok() ? parse_navigation_file(*text, "made.nav") : Result<NavigationData>(text.error());
    if (!read.ok()) return {kNone, 0.0};
    if (system == GnssSystem::kGlonass) {
      take_worst(out, read->glonass.size() == 1 ? apart_s(read->glonass[0].toe.ns, data.glonass[0].toe.ns) : kNone);
    } else {
      const bool one = read->kepler.size() == 1;
      take_worst(out, one ? apart_s(read->kepler[0].toe.ns, t.ns) : kNone);
      take_worst(out, one ? apart_s(read->kepler[0].toc.ns, t.ns) : kNone);
    }
  }
  return out;
}

/// Observations have epochs of 100 ns: half of one is lost. Fractions just below a second must carry into the minute.
StressFigure observations() {
  StressFigure out{0.0, 50e-9};
  for (const GpsTime border : borders())
    for (const std::int64_t ns :
         {-1'000'000'000LL, -100LL, -51LL, -50LL, -49LL, -1LL, 0LL, 1LL, 49LL, 51LL, 59'999'999'960LL}) {
      const GpsTime t{border.ns + ns};
      const ObservationWriter writer({.first = t, .bands = {{GnssSystem::kGps, {1}}}});
      GnssEpoch epoch;
      epoch.t = t;
      GnssObservation o;
      o.sv = {GnssSystem::kGps, 3};
      o.pseudorange_m = 2.2e7;
      epoch.observations.push_back(o);
      const auto read = parse_observation_file(writer.header() + writer.epoch(epoch), "made.obs");
      take_worst(out, read.ok() && read->epochs.size() == 1 ? apart_s(read->epochs[0].t.ns, t.ns) : kNone);
    }
  return out;
}

NmeaEpoch nmea_epoch(GpsTime t, const Geodetic& place) {
  NmeaEpoch e;
  e.fix.t = t;
  e.fix.status = FixStatus::kSingle;
  e.fix.p_A_E = ecef_from_geodetic(place);
  e.fix.satellites = 8;
  return e;
}

/// NMEA has hundredths of UTC: half of one is lost; 23:59:60 has its label and comes back.
StressFigure nmea_times() {
  StressFigure out{0.0, 5e-3};
  for (const GpsTime border : borders())
    for (const std::int64_t ms : {-1004, -1000, -996, -6, -5, -4, 0, 4, 5, 6, 996, 1000}) {
      const GpsTime t{border.ns + ms * 1'000'000};
      if (calendar(t).year > 2078) continue;  // two digits of the year: 80 is 1980
      const auto read = parse_nmea(nmea_text(nmea_epoch(t, {0.5, 1.0, 10.0})), "made.nmea");
      take_worst(out, read.ok() && read->records.size() == 1 ? apart_s(read->records[0].t.ns, t.ns) : kNone);
    }
  return out;
}

/// Seven decimals of a minute: half of one is 0.093 mm of latitude, 1 mm of height; rounding never makes 60 minutes.
StressFigure nmea_places() {
  StressFigure out{0.0, 1.0};
  const GpsTime t = GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0);
  for (const double lat : {-90.0, -89.99999999999, -0.99999999999, -1e-12, 0.0, 59.99999999999, 90.0})
    for (const double lon :
         {-180.0, -179.99999999999, -99.99999999999, -1e-12, 0.0, 0.99999999999, 179.99999999999, 180.0})
      for (const double h : {-400.0, -0.0004, 0.0, 19999.9996}) {
        const Geodetic g{lat * kDegree, lon * kDegree, h};
        const auto read = parse_nmea(nmea_text(nmea_epoch(t, g)), "made.nmea");
        if (!read.ok() || read->records.size() != 1) return {kNone, 1.0};
        const Eigen::Vector3d apart = ecef_from_geodetic(read->records[0].place) - ecef_from_geodetic(g);
        // Half a unit of each angle is 0.0928 mm, of height 0.5 mm; and rounding of E, 1e-9 m.
        take_worst(out, apart.norm() / (std::hypot(0.0928e-3, 0.0928e-3, 0.5e-3) + 1e-8));
      }
  return out;
}

/// Numbers of seconds of a week to the instant nearest to a time: half a week away at most, of that second of week.
StressFigure nearest() {
  StressFigure out;
  for (const GpsTime near : seconds_around())
    for (const double sow : {0.0, 1.0, 302399.0, 302400.0, 302401.0, 604799.0}) {
      const GpsTime found = nearest_with_sow(sow, near);
      const double apart = std::abs(found - near);
      take_worst(out, found.ns >= 0 ? std::abs(found.sow_s() - sow) : 0.0);
      take_worst(out, beyond(apart, 302400.0));
    }
  return out;
}

/// Two digits of a year: 80 to 99 are 1980 to 1999, 00 to 79 are 2000 to 2079. A figure counts what differs.
StressFigure two_digits() {
  StressFigure out;
  for (int year = 1981; year < 2080; ++year) {
    const std::string line = printed(" 1 %02d 12 31 23 59 59.0", year % 100);
    const auto t = epoch_of_line(line, true);
    out.figure += t && *t == GpsTime::from_calendar(year, 12, 31, 23, 59, 59.0) ? 0.0 : 1.0;
  }
  return out;
}

/// Dates that are none: the 29th of February but every fourth year and not 2100, the 31st, the 0th, the 13th month.
StressFigure dates() {
  StressFigure out;
  const auto expect = [&](bool known, int y, int m, int d) { out.figure += is_date(y, m, d) == known ? 0.0 : 1.0; };
  expect(true, 2000, 2, 29), expect(false, 2100, 2, 29), expect(true, 2004, 2, 29), expect(false, 2001, 2, 29);
  expect(false, 2001, 4, 31), expect(false, 2001, 13, 1), expect(false, 2001, 0, 1), expect(false, 2001, 1, 0);
  expect(false, 1979, 12, 31), expect(false, 2201, 1, 1), expect(true, 2200, 12, 31);
  const auto taken = [&](double second) { out.figure += time_of_fields(2010, 7, 1, 13, 0, second) ? 1.0 : 0.0; };
  taken(61.0), taken(-1e-9), taken(kNone), taken(std::numeric_limits<double>::infinity());
  return out;
}

/// UTC to GPS time and back across all leap seconds, hundredths apart; the second 60 between both sides. Exact.
StressFigure utc() {
  StressFigure out;
  for (const GpsTime border : borders())
    for (int k = -150; k <= 150; ++k) {
      const GpsTime t{border.ns + k * 10'000'000LL};
      const int leap = t.leap_seconds();
      const bool second_60 = GpsTime{t.ns + kNsPerSecond}.leap_seconds() > leap;
      const GpsTime label{t.ns - leap * kNsPerSecond};  // second 60 reads 0 of the next minute
      take_worst(out, apart_s(gps_time_of_utc(label, second_60).ns, t.ns));
    }
  return out;
}

/// An almanac counts weeks modulo 1024: of any turn the nearest is meant.
StressFigure almanac_weeks() {
  StressFigure out;
  for (const int week : {10, 1023, 1024, 1025, 2047, 2048, 3071, 4000}) {
    for (const int off_days : {-3000, 0, 3000}) {
      const std::string text = printed(
          "******** Week %d almanac for PRN-01 ********\nID:                         01\n"
          "Health:                     000\nEccentricity:               0.5E-002\n"
          "Time of Applicability(s):  589824.0000\nOrbital Inclination(rad):   0.9637857480\n"
          "Rate of Right Ascen(r/s):  -0.7897471819E-008\nSQRT(A)  (m 1/2):           5153.602051\n"
          "Right Ascen at Week(rad):  -0.1159458779E+001\nArgument of Perigee(rad):   0.451712027\n"
          "Mean Anom(rad):            -0.2105941778E+001\nAf0(s):                     0.1621246338E-004\n"
          "Af1(s/s):                   0.0000000000E+000\nweek:                        %d\n",
          week % 1024, week % 1024);
      const GpsTime meant = GpsTime::from_week_sow(week, 589824.0);
      if (week < 500 && off_days < 0) continue;  // before 1980
      const auto read = parse_almanac_file(text, "made.alm", meant + 86400.0 * off_days);
      take_worst(out, read.ok() && read->kepler.size() == 1 ? apart_s(read->kepler[0].toe.ns, meant.ns) : kNone);
    }
  }
  return out;
}

std::string padded(std::string text, const char* label) {
  text.resize(60, ' ');
  return text + label + "\n";
}

std::string date(GpsTime t, const char* format) {
  const CalendarTime c = calendar(t);
  return printed(format, c.year, c.month, c.day, c.hour, c.minute, c.second);
}

/// SP3 in GPS time and in UTC, RINEX clocks in GPS time: epochs come back to the nanosecond.
StressFigure tables(const std::string& scale) {
  StressFigure out;
  for (const GpsTime t : seconds_around()) {
    const bool utc_scale = scale == "UTC";
    if (utc_scale && GpsTime{t.ns + kNsPerSecond}.leap_seconds() > t.leap_seconds()) continue;  // second 60: no label
    const GpsTime label{t.ns - (utc_scale ? t.leap_seconds() * kNsPerSecond : 0)};
    std::string sp3 = date(label, "#dP%4d %2d %2d %2d %2d %11.8f") + "       1 ORBIT IGS14 HLM  IGS\n";
    sp3 += printed("## %4d %15.8f %14.8f %5d %15.13f\n", label.week(), label.sow_s(), 900.0, 55378, 0.0);
    sp3 += "+    1   G01\n%c M  cc " + scale + " ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";
    sp3 += date(label, "*  %4d %2d %2d %2d %2d %11.8f") +
           "\nPG01  15000.000000  20000.000000  10000.000000    123.456789\nEOF\n";
    const auto orbits = parse_sp3_file(sp3, "made.sp3");
    if (!orbits.ok() || orbits->satellites.size() != 1) return {kNone, 0.0};
    take_worst(out, apart_s(orbits->satellites.begin()->second.front().t.ns, t.ns));

    const std::string clk =
        padded("     3.00           C                                       ", "RINEX VERSION / TYPE") +
        padded("   " + scale, "TIME SYSTEM ID") + padded("", "END OF HEADER") + "AS G01 " +
        date(label, " %4d %02d %02d %02d %02d %9.6f") + "  1    1.000000000000E-04\n";
    const auto clocks = parse_clock_file(clk, "made.clk");
    if (!clocks.ok()) return {kNone, 0.0};
    take_worst(out, apart_s(clocks->satellites.begin()->second.front().t.ns, t.ns));
  }
  return out;
}

/// Maps of the ionosphere, whose epochs are UTC, an hour apart across each border: to the nanosecond.
StressFigure ionosphere_maps() {
  StressFigure out;
  for (const GpsTime t : seconds_around()) {
    std::string text =
        padded("     1.0            IONOSPHERE MAPS", "IONEX VERSION / TYPE") + padded("     2", "MAP DIMENSION") +
        padded("  6371.0", "BASE RADIUS") + padded("   450.0 450.0   0.0", "HGT1 / HGT2 / DHGT") +
        padded("    10.0 -10.0 -20.0", "LAT1 / LAT2 / DLAT") + padded("  -180.0 180.0 180.0", "LON1 / LON2 / DLON") +
        padded("    -1", "EXPONENT") + padded("", "END OF HEADER");
    std::vector<GpsTime> times;
    for (const GpsTime at : {t, t + 3600.0}) {
      if (GpsTime{at.ns + kNsPerSecond}.leap_seconds() > at.leap_seconds()) continue;  // second 60: no label
      times.push_back(at);
      const CalendarTime c = calendar(GpsTime{at.ns - at.leap_seconds() * kNsPerSecond});
      const std::string number = printed("%6d", static_cast<int>(times.size()));
      text += padded(number, "START OF TEC MAP") +
              padded(printed("%6d%6d%6d%6d%6d%6.0f", c.year, c.month, c.day, c.hour, c.minute, c.second),
                     "EPOCH OF CURRENT MAP");
      for (const double lat_deg : {10.0, -10.0})
        text += padded(printed("  %6.1f%6.1f%6.1f%6.1f%6.1f", lat_deg, -180.0, 180.0, 180.0, 450.0),
                       "LAT/LON1/LON2/DLON/H") +
                "  100  100  100\n";
      text += padded(number, "END OF TEC MAP");
    }
    const auto read = parse_ionex_file(text + padded("", "END OF FILE"), "made.ionex");
    if (!read.ok() || read->maps.size() != times.size()) return {kNone, 0.0};
    for (std::size_t k = 0; k < times.size(); ++k) take_worst(out, apart_s(read->maps[k].t.ns, times[k].ns));
  }
  return out;
}

}  // namespace

std::vector<StressCase> time_border_cases() {
  StressRows rows;
  rows.of({StressGroup::kLong, "an ephemeris at the borders of weeks, years and leap seconds",
           "week counts of 10 bits, a toe of the next week, GLONASS's UTC by the wrong number of leap seconds",
           "written and read again: the same nanosecond, at 168 seconds around 24 borders", "s"});
  rows.add("time_borders/navigation_gps", [] { return navigation(GnssSystem::kGps); })
      .add("time_borders/navigation_galileo", [] { return navigation(GnssSystem::kGalileo); })
      .add("time_borders/navigation_beidou", [] { return navigation(GnssSystem::kBeidou); })
      .add("time_borders/navigation_glonass", [] { return navigation(GnssSystem::kGlonass); });
  rows.of({StressGroup::kLong, "an epoch that rounds up into the next minute, day or year",
           "fields that read 60, or a second that is rounded after it was cut off",
           "half a unit of the format's last digit", "s"});
  rows.add("time_borders/observation_epochs", observations).add("time_borders/nmea_times", nmea_times);
  rows.of({StressGroup::kGeometry, "a place in degrees and minutes at poles, antimeridian and equator",
           "59.99999999 minutes that become 60, a sign lost with 0 degrees, 180 W and 180 E",
           "half a unit of the last digits: 0.093 mm by angle, 0.5 mm of height", "of half a unit"});
  rows.add("time_borders/nmea_places", nmea_places);
  rows.of({StressGroup::kLong, "a second of week without its week",
           "a tie of half a week, a remainder of the wrong sign", "of that second, at most half a week away", "s"});
  rows.add("time_borders/nearest_second_of_week", nearest);
  rows.of({StressGroup::kLong, "years of two digits and dates that are none", "a pivot off by one; 29 February 2100",
           "1981 to 2079 each themselves; impossible dates and seconds refused", "differences"});
  rows.add("time_borders/years_of_two_digits", two_digits).add("time_borders/dates_that_are_none", dates);
  rows.of({StressGroup::kLong, "UTC across leap seconds", "the new count a second early or late; second 60 taken for 0",
           "exact, at 10 ms steps over 3 s around each border", "s"});
  rows.add("time_borders/utc_across_leap_seconds", utc);
  rows.of({StressGroup::kLong, "weeks modulo 1024", "the first turn of 1980 instead of the nearest",
           "the turn nearest to the time given, 3000 days away or near", "s"});
  rows.add("time_borders/almanac_weeks", almanac_weeks);
  rows.of({StressGroup::kLong, "orbit and clock tables at the borders of weeks, years and leap seconds",
           "a time scale taken for another; fields that read 60", "the same nanosecond", "s"});
  rows.add("time_borders/tables_in_gps_time", [] { return tables("GPS"); })
      .add("time_borders/tables_in_utc", [] { return tables("UTC"); })
      .add("time_borders/ionosphere_maps", ionosphere_maps);
  return rows.take();
}

}  // namespace canyon::gnss
