#include "canyon/core/time.h"

#include <cstdint>

#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"

namespace canyon {
namespace {

bool survives_text(GpsTime t) {
  const auto read = GpsTime::parse(t.iso(9), "stress");
  const CalendarTime c = calendar(t);
  return read.ok() && *read == t && GpsTime::from_calendar(c.year, c.month, c.day, c.hour, c.minute, c.second) == t;
}

/// The first instant of every month there is, and the nanoseconds before and after.
StressFigure month_borders() {
  int wrong = 0;
  for (int year = 1980; year <= 2261; ++year)
    for (int month = 1; month <= 12; ++month)
      for (const std::int64_t beside : {-1, 0, 1}) {
        const GpsTime t{GpsTime::from_calendar(year, month, 1, 0, 0, 0.0).ns + beside};
        if (t.ns >= 0) wrong += survives_text(t) ? 0 : 1;
      }
  return {1.0 * wrong, 0.0};
}

/// The 29th of February is there in leap years alone, centuries that 400 does not divide are none.
StressFigure leap_days() {
  int wrong = 0;
  for (int year = 1980; year <= 2261; ++year) {
    const bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    const bool read = GpsTime::parse(std::to_string(year) + "-02-29", "stress").ok();
    const double days =
        (GpsTime::from_calendar(year, 3, 1, 0, 0, 0.0) - GpsTime::from_calendar(year, 2, 28, 0, 0, 0.0)) / 86400.0;
    wrong += (read == leap ? 0 : 1) + (days == (leap ? 2.0 : 1.0) ? 0 : 1);
  }
  return {1.0 * wrong, 0.0};
}

/// First and last nanosecond of every week to the last, the borders of its counters of 10 and 13 bits among them.
StressFigure week_borders() {
  int wrong = 0;
  for (int week = 0; week < 14700; ++week) {
    const GpsTime first = GpsTime::from_week_sow(week, 0.0), last = GpsTime::from_week_sow(week, 604799.999999999);
    wrong += first.week() == week && first.sow_ns() == 0 ? 0 : 1;
    wrong += last.week() == week && last.sow_ns() == 604799999999999 ? 0 : 1;
    wrong += GpsTime{last.ns + 1} == GpsTime::from_week_sow(week + 1, 0.0) ? 0 : 1;
    wrong += first.sow_s() == 0.0 && last.sow_s() < kSecondsPerWeek ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// Half-years that end with a leap second, as IERS Bulletin C announced them: year, and 6 or 12.
constexpr int kLeapHalves[18][2] = {{1981, 6},  {1982, 6},  {1983, 6},  {1985, 6}, {1987, 12}, {1989, 12},
                                    {1990, 12}, {1992, 6},  {1993, 6},  {1994, 6}, {1995, 12}, {1997, 6},
                                    {1998, 12}, {2005, 12}, {2008, 12}, {2012, 6}, {2015, 6},  {2016, 12}};

bool ends_with_leap_second(int year, int month) {
  for (const auto& half : kLeapHalves)
    if (half[0] == year && half[1] == month) return true;
  return false;
}

/// Seconds of UTC one after the other over the end of every half-year to 2030.
StressFigure leap_seconds() {
  int wrong = 0, so_far = 0;
  for (int year = 1980; year <= 2030; ++year)
    for (const int month : {6, 12}) {
      const bool leap = ends_with_leap_second(year, month);
      const std::string day = std::to_string(year) + (month == 6 ? "-06-30" : "-12-31");
      const std::string next = month == 6 ? std::to_string(year) + "-07-01" : std::to_string(year + 1) + "-01-01";
      const auto last = GpsTime::parse(day + "T23:59:59Z", "stress"),
                 extra = GpsTime::parse(day + "T23:59:60Z", "stress"),
                 after = GpsTime::parse(next + "T00:00:00Z", "stress");
      if (!last.ok() || !after.ok() || extra.ok() != leap) {
        ++wrong;
        continue;
      }
      wrong += after->ns - last->ns == (leap ? 2 : 1) * kNsPerSecond ? 0 : 1;
      if (leap) wrong += extra->ns - last->ns == kNsPerSecond ? 0 : 1;
      wrong += last->leap_seconds() == so_far ? 0 : 1;
      so_far += leap ? 1 : 0;
      wrong += after->leap_seconds() == so_far ? 0 : 1;
    }
  return {1.0 * wrong, 0.0};
}

/// Durations of whole nanoseconds, up to 10^15 of them (12 days, which a double of seconds holds to 0.1 ns).
StressFigure durations_from(std::int64_t base_ns) {
  int wrong = 0;
  for (const std::int64_t beside : {-1, 0, 1})
    for (std::int64_t d = 1; d <= 1'000'000'000'000'000; d = d * 7 + 3) {
      const GpsTime t{base_ns + beside}, later = t + 1e-9 * static_cast<double>(d);
      wrong += later.ns - t.ns == d ? 0 : 1;
      wrong += std::llround((later - t) * 1e9) == d && std::llround((t - later) * 1e9) == -d ? 0 : 1;
      wrong += later - 1e-9 * static_cast<double>(d) == t ? 0 : 1;
      wrong += base_ns >= 0 && survives_text(later) ? 0 : 1;
    }
  return {1.0 * wrong, 0.0};
}

/// Ticks of a day against a quotient in 64 bits of mantissa, which is good to 1e-5 ns there.
StressFigure ticks_of_a_day(double rate_hz) {
  const GpsTime start = GpsTime::from_week_sow(2160, 345600.0);
  const auto last = static_cast<std::int64_t>(86400.0 * rate_hz);
  const std::int64_t stride = std::max<std::int64_t>(1, last / 20011);
  double worst_ns = 0.0;
  GpsTime before = start;
  for (std::int64_t k = 1; k <= last; k += stride) {
    const GpsTime t = tick(start, k, rate_hz);
    const long double exact_ns = static_cast<long double>(k) * 1e9L / static_cast<long double>(rate_hz);
    const double miss_ns = static_cast<double>(static_cast<long double>(t.ns - start.ns) - exact_ns);
    worst_ns = worse(worst_ns, t > before ? std::abs(miss_ns) : stress::kInfinity);
    before = t;
  }
  return {worst_ns, 0.5 + 1e-4};
}

/// What does not fit 64 bits of nanoseconds.
StressFigure overflows() {
  const GpsTime far{9'000'000'000'000'000'000}, early{-9'000'000'000'000'000'000};
  int passed = 0;
  passed += stress::not_refused([&] { return far + 1e9; });
  passed += stress::not_refused([&] { return early - 1e9; });
  passed += stress::not_refused([&] { return far - early; });
  passed += stress::not_refused([&] { return far + stress::kInfinity; });
  passed += stress::not_refused([&] { return far + (stress::kInfinity - stress::kInfinity); });
  passed += stress::not_refused([&] { return tick({}, 8'999'999'999, 1e-3); });
  passed += stress::not_refused([&] { return tick(far, 1'000'000'000, 1.0); });
  passed += stress::not_refused([&] { return GpsTime::from_week_sow(2'000'000'000, 0.0); });
  passed += stress::not_refused([&] { return GpsTime::from_week_sow(-2'000'000'000, 0.0); });
  return {1.0 * passed, 0.0};
}

}  // namespace

std::vector<StressCase> time_cases() {
  const auto group = StressGroup::kGeometry;
  const StressMechanism calendar_field{
      group, "a calendar field at its border",
      "years counted from January lose the leap day; rounding 59.9999999996 s does not carry into the minute",
      "every instant reads back from its text and its fields to the nanosecond: exact", "instants"};
  const StressMechanism week_count{group, "the count of weeks at its borders",
                                   "a week taken modulo 1024, or seconds of week that round up to 604800",
                                   "first and last nanosecond of each of 14700 weeks keep week and second: exact",
                                   "instants"};
  const StressMechanism leap{
      group, "an inserted second",
      "the table is off by one row or one second, or 23:59:60 is taken where there is none",
      "over the end of every half-year UTC goes on second by second, two at the 18 leap seconds: exact", "instants"};
  const StressMechanism large{
      StressGroup::kLong, "more nanoseconds than a double holds",
      "an instant that passes through a double loses its nanoseconds from 104 days on, through 32 bits from 2048 on",
      "instants plus durations of up to 10^15 ns come out exact, and so do their differences", "instants"};
  const StressMechanism ticks{
      StressGroup::kLong, "a period that is added up", "a rate whose period is no whole number of nanoseconds drifts",
      "tick k lies within half a nanosecond of k / rate at the end of a day too: rounding to the nearest, no more",
      "ns"};
  const StressMechanism overflow{
      StressGroup::kData, "overflow of 64 bits",
      "the sum wraps around to an instant 584 years off, without a word (found by this case, 2026-11-22)",
      "each of them is refused", "let through"};
  StressRows rows;
  rows.of(calendar_field).add("time/month_borders_1980_to_2261", month_borders);
  rows.of(calendar_field).add("time/leap_days", leap_days);
  rows.of(week_count).add("time/week_borders", week_borders);
  rows.of(leap).add("time/leap_seconds", leap_seconds);
  rows.of(overflow).add("time/beyond_2272_is_refused", overflows);
  rows.of(large).add("time/near_31_bits_of_seconds",
                     [] { return durations_from((std::int64_t{1} << 31) * kNsPerSecond); });
  rows.of(large).add("time/near_53_bits_of_ns", [] { return durations_from(std::int64_t{1} << 53); });
  rows.of(large).add("time/near_62_bits_of_ns", [] { return durations_from(std::int64_t{1} << 62); });
  for (const double rate_hz : {0.01, 0.3, 9.99, 300.0, 10000.0})
    rows.of(ticks).add("time/ticks_of_a_day_at_" + stress::text(rate_hz) + "_hz",
                       [rate_hz] { return ticks_of_a_day(rate_hz); });
  return rows.take();
}

}  // namespace canyon
