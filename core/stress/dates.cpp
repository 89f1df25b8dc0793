// Days of the year, and instants as texts and fields.
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/time.h"

namespace canyon {
namespace {

using stress::kEpsilon;
using stress::Looks;
using stress::not_refused;

constexpr std::int64_t kDay_ns = 86400 * kNsPerSecond;

/// The first is day 1, whatever was before it; noon is half a day more. A day of 366 is rounded twice, by half of
/// 2^-44.
StressFigure days_of_years() {
  Looks looks;
  const int lengths[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  for (int year = 1980; year <= 2261; ++year) {
    const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    int day = 1;
    for (int month = 1; month <= 12; ++month) {
      const GpsTime first = GpsTime::from_calendar(year, month, 1, 0, 0, 0.0);
      looks.right(first.day_of_year() == 1.0 * day);
      looks.near(GpsTime{first.ns + kDay_ns / 2}.day_of_year(), day + 0.5, 256.0 * kEpsilon);
      looks.near(GpsTime{first.ns + 3 * kDay_ns + 7 * kNsPerSecond}.day_of_year(), day + 3.0 + 7.0 / 86400.0,
                 512.0 * kEpsilon);
      day += lengths[month - 1] + (leap && month == 2 ? 1 : 0);
    }
    looks.right(day == (leap ? 367 : 366));
  }
  // Before the first instant that there is counts by its own year.
  looks.near(GpsTime{-kDay_ns}.day_of_year(), 5.0, 8.0 * kEpsilon);
  looks.near(GpsTime{-6 * kDay_ns}.day_of_year(), 365.0, 256.0 * kEpsilon);
  return looks.figure();
}

GpsTime instant(std::int64_t week, std::int64_t sow_s, std::int64_t ns = 0) {
  return {(week * 604800 + sow_s) * kNsPerSecond + ns};
}

/// Thursday, 1 July 2010 is day 4 of GPS week 1590; GPS time was 15 s ahead of UTC. Weeks of Sundays: by any calendar.
StressFigure texts_read() {
  int wrong = 0;
  const std::pair<const char*, GpsTime> good[] = {
      {"1980-01-06", {0}},
      {"1980-01-06T00:00:00.000000001", {1}},
      {"1980-01-06 00:00:01.5", {1'500'000'000}},
      {"1980-01-06T00:01", {60 * kNsPerSecond}},
      {"1980-01-07", {kDay_ns}},
      {"2010-07-01", instant(1590, 345600)},
      {"2010-07-01Z", instant(1590, 345615)},
      {"2010-07-01T13:00", instant(1590, 392400)},
      {"2010-07-01T13:00Z", instant(1590, 392415)},
      {"2010-07-01T13:00:07.25", instant(1590, 392407, 250'000'000)},
      {"2010-07-01 13:00:07.25Z", instant(1590, 392422, 250'000'000)},
      {"2010-07-01T23:59:59", instant(1590, 431999)},
      {"2016-12-31T23:59:60Z", instant(1930, 17)},
      {"2017-01-01T00:00:00Z", instant(1930, 18)},
      {"2261-12-31T23:59:59.999999999", instant(14713, 259199, 999'999'999)},
      {"0:0", {0}},
      {"01590:392400", instant(1590, 392400)},
      {"1590:392400.5", instant(1590, 392400, 500'000'000)},
      {"1590:604799.999999999", instant(1590, 604799, 999'999'999)},
      {"1590:0.1234567894", instant(1590, 0, 123'456'789)},
      {"1590:0.1234567895", instant(1590, 0, 123'456'790)},
      {"1590:0.9999999999", instant(1590, 1)},
      {"14713:604799", instant(14713, 604799)},
  };
  for (const auto& [text, t] : good) {
    const auto found = GpsTime::parse(text, "stress");
    wrong += found.ok() && *found == t ? 0 : 1;
  }
  for (const char* text : {"",
                           "2010-7-1",
                           "2010-07-1",
                           "10-07-01",
                           "2010-13-01",
                           "2010-00-10",
                           "2010-02-29",
                           "2010-04-31",
                           "2010-07-00",
                           "2010-07-32",
                           "2010-07",
                           "2010/07/01",
                           " 2010-07-01",
                           "2010-07-01 ",
                           "2010-07-01T",
                           "1980-01-05",
                           "2010-07-01T13",
                           "2010-07-01T24:00",
                           "2010-07-01T13:60",
                           "2010-07-01T13:00:60",
                           "1979-12-31",
                           "2262-01-01",
                           "2016-12-31T23:59:60",
                           "2016-12-31T23:59:61Z",
                           "2010-07-01T13:00:60Z",
                           "1590",
                           "2010-07-01T13:00:",
                           "2010-07-01T13:00:0.",
                           "2010-07-01T13:00:00.",
                           "2010-07-01T13:00:00.5X",
                           "1590:",
                           "2010-07-01T13:00ZZ",
                           "2010-07-01t13:00",
                           "2010-07-01T13.00",
                           "1590:604800",
                           ":5",
                           "1590:-1",
                           "1590:1.",
                           "1590:1:2",
                           "159000:0",
                           "14714:0",
                           "1590:1234567",
                           "+590:1",
                           "1590;1",
                           "-1590:1"})
    wrong += GpsTime::parse(text, "stress").ok() ? 1 : 0;
  const auto none = GpsTime::parse("noon", "--start");
  wrong += !none.ok() && none.error().str() ==
                             "--start: \"noon\" is not a time, expected YYYY-MM-DDTHH:MM:SS (GPS time), the same with "
                             "a trailing Z (UTC), or WEEK:SECONDS_OF_WEEK, from 1980-01-06 to 2261-12-31"
               ? 0
               : 1;
  return {1.0 * wrong, 0.0};
}

/// As they are written, with each number of decimals: rounded before they are split, half of a unit upwards.
StressFigure texts_written() {
  int wrong = 0;
  const auto is = [&](GpsTime t, int decimals, const char* text) { wrong += t.iso(decimals) == text ? 0 : 1; };
  const GpsTime t = instant(1590, 392459, 999'600'000);
  is(t, 9, "2010-07-01T13:00:59.999600000"), is(t, 6, "2010-07-01T13:00:59.999600");
  is(t, 4, "2010-07-01T13:00:59.9996"), is(t, 3, "2010-07-01T13:01:00.000"), is(t, 0, "2010-07-01T13:01:00");
  wrong += t.iso() == t.iso(3) ? 0 : 1;
  const GpsTime digits = instant(1042, 604799, 123'456'789);
  const char* of_digits[] = {"",       ".1",      ".12",      ".123",      ".1235",
                             ".12346", ".123457", ".1234568", ".12345679", ".123456789"};
  for (int n = 0; n < 10; ++n) is(digits, n, (std::string("2000-01-01T23:59:59") + of_digits[n]).c_str());
  is({-1}, 9, "1980-01-05T23:59:59.999999999"), is({-1}, 8, "1980-01-06T00:00:00.00000000");
  is({500'000'000}, 0, "1980-01-06T00:00:01"), is({499'999'999}, 0, "1980-01-06T00:00:00");
  is({-500'000'000}, 0, "1980-01-06T00:00:00"), is({-500'000'001}, 0, "1980-01-05T23:59:59");
  is(instant(1042, 518399, 999'999'999), 8, "2000-01-01T00:00:00.00000000");
  is(instant(14713, 259199, 999'999'999), 9, "2261-12-31T23:59:59.999999999");
  wrong += not_refused([&] { return t.iso(-1); }, "decimals = -1");
  wrong += not_refused([&] { return t.iso(10); }, "decimals = 10");
  return {1.0 * wrong, 0.0};
}

/// Fields to an instant and back, also of hours and seconds that end a day or a leap second; and ticks of a clock,
/// either way, halves away from the start.
StressFigure fields_and_ticks() {
  int wrong = 0;
  const auto is = [&](bool holds) { wrong += holds ? 0 : 1; };
  is(GpsTime::from_calendar(2010, 7, 1, 13, 0, 59.9996) == instant(1590, 392459, 999'600'000));
  is(GpsTime::from_calendar(2010, 6, 30, 24, 0, 0.0) == instant(1590, 345600));
  is(GpsTime::from_calendar(2016, 12, 31, 23, 59, 60.5) == instant(1930, 0, 500'000'000));
  const CalendarTime c = calendar(instant(1590, 392459, 999'600'000));
  is(c.year == 2010 && c.month == 7 && c.day == 1 && c.hour == 13 && c.minute == 0 && c.second == 59.9996);
  const CalendarTime early = calendar({-1});
  is(early.year == 1980 && early.month == 1 && early.day == 5 && early.hour == 23 && early.minute == 59);
  is(early.second == 59.999999999 && GpsTime{-1}.week() == -1 && GpsTime{-1}.sow_ns() == 604'799'999'999'999);
  is(instant(1590, 392459, 999'600'000).week() == 1590 && instant(1590, 5, 250'000'000).sow_s() == 5.25);
  is(instant(1590, 392459).leap_seconds() == 15 && GpsTime{-1}.leap_seconds() == 0);
  wrong += not_refused([] { return GpsTime::from_calendar(1979, 1, 1, 0, 0, 0.0); }, "year = 1979");
  wrong += not_refused([] { return GpsTime::from_calendar(2262, 1, 1, 0, 0, 0.0); }, "year = 2262");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 0, 1, 0, 0, 0.0); }, "month = 0, day = 1");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 13, 1, 0, 0, 0.0); }, "month = 13");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 0, 0, 0, 0.0); }, "day = 0");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 32, 0, 0, 0.0); }, "day = 32");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 1, -1, 0, 0.0); }, "hour = -1");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 1, 25, 0, 0.0); }, "hour = 25");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 1, 0, 60, 0.0); }, "minute = 60");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 1, 0, -1, 0.0); }, "minute = -1");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 1, 0, 0, 61.0); }, "second = 61");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 1, 0, 0, -0.5); }, "second = -0.5");
  wrong += not_refused([] { return GpsTime::from_calendar(2010, 1, 1, 0, 0, std::nan("")); }, "second = ");
  const GpsTime start = instant(2000, 7);
  const auto ticks = [&](std::int64_t k, double rate_hz) { return tick(start, k, rate_hz).ns - start.ns; };
  is(ticks(1, 3.0) == 333'333'333 && ticks(2, 3.0) == 666'666'667 && ticks(-1, 3.0) == -333'333'333);
  is(ticks(1, 4e8) == 3 && ticks(-1, 4e8) == -3 && ticks(3, 4e8) == 8 && ticks(-3, 4e8) == -8 && ticks(2, 4e8) == 5);
  is(ticks(5, 1e-3) == 5'000 * kNsPerSecond && ticks(7, 1e9) == 7 && ticks(0, 17.3) == 0 &&
     ticks(-2, 0.5) == -4 * kNsPerSecond);
  is(ticks(8'999'999'999, 100.0) == 89'999'999'990'000'000);
  wrong += not_refused([&] { return tick(start, 1, 0.999e-3); }, "rate_hz = 0.000999");
  wrong += not_refused([&] { return tick(start, 1, 1.001e9); }, "rate_hz = ");
  wrong += not_refused([&] { return tick(start, 9'000'000'000, 1e6); }, "k = 9000000000");
  wrong += not_refused([&] { return tick(start, -9'000'000'000, 1e6); }, "k = -9000000000");
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> date_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the day of the year", "the first counted as none, or a leap day before it has been",
           "lengths of the months added up: exact at midnight, two roundings of 366 beside it", "of the bound"});
  rows.add("dates/days_of_years", days_of_years);
  rows.of({StressGroup::kData, "instants as texts and fields",
           "a form that is taken for another, a digit past the ninth that is cut off, a field beyond its border",
           "each text's own instant, by weeks of the calendar, or its refusal in words: exact", "wrong"});
  rows.add("dates/texts_read", texts_read)
      .add("dates/texts_written", texts_written)
      .add("dates/fields_and_ticks", fields_and_ticks);
  return rows.take();
}

}  // namespace canyon
