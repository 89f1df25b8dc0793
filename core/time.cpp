#include "canyon/core/time.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "canyon/core/check.h"

namespace canyon {
namespace {

constexpr std::int64_t kSecondsPerDay = 86400;
constexpr std::int64_t kNsPerDay = kSecondsPerDay * kNsPerSecond;
constexpr std::int64_t kNsPerWeek = 7 * kNsPerDay;

/// Quotient rounded towards minus infinity; instants before the epoch have negative nanoseconds.
constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

/// Days from 1970-01-01 of a date of the Gregorian calendar. Years are counted from March, so that the leap day comes
/// last.
constexpr std::int64_t days_from_civil(int year, int month, int day) {
  const std::int64_t y = month <= 2 ? year - 1 : year;
  const std::int64_t era = floor_div(y, 400);
  const std::int64_t year_of_era = y - era * 400;
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719468;
}

constexpr std::int64_t kEpochDay = days_from_civil(1980, 1, 6);

constexpr std::int64_t ns_of_date(int year, int month, int day) {
  return (days_from_civil(year, month, day) - kEpochDay) * kNsPerDay;
}

/// UTC midnights at which GPS minus UTC grew by a second; row i: to i + 1. Source: IERS Bulletin C; none since 2017.
constexpr std::array kLeapMidnights = {ns_of_date(1981, 7, 1), ns_of_date(1982, 7, 1), ns_of_date(1983, 7, 1),
                                       ns_of_date(1985, 7, 1), ns_of_date(1988, 1, 1), ns_of_date(1990, 1, 1),
                                       ns_of_date(1991, 1, 1), ns_of_date(1992, 7, 1), ns_of_date(1993, 7, 1),
                                       ns_of_date(1994, 7, 1), ns_of_date(1996, 1, 1), ns_of_date(1997, 7, 1),
                                       ns_of_date(1999, 1, 1), ns_of_date(2006, 1, 1), ns_of_date(2009, 1, 1),
                                       ns_of_date(2012, 7, 1), ns_of_date(2015, 7, 1), ns_of_date(2017, 1, 1)};
static_assert(kLeapMidnights.size() == 18);

constexpr int kFirstYear = 1980;
constexpr int kLastYear = 2261;

}  // namespace

GpsTime GpsTime::from_week_sow(int week, double sow_s) {
  std::int64_t ns = 0;
  CANYON_CHECK(!__builtin_mul_overflow(std::int64_t{week}, kNsPerWeek, &ns), "week = ", week);
  return GpsTime{ns} + sow_s;
}

GpsTime GpsTime::from_calendar(int year, int month, int day, int hour, int minute, double second) {
  CANYON_CHECK(year >= kFirstYear && year <= kLastYear, "year = ", year);
  CANYON_CHECK(month >= 1 && month <= 12 && day >= 1 && day <= 31, "month = ", month, ", day = ", day);
  CANYON_CHECK(hour >= 0 && hour <= 24 && minute >= 0 && minute < 60, "hour = ", hour, ", minute = ", minute);
  CANYON_CHECK(second >= 0.0 && second < 61.0, "second = ", second);
  const std::int64_t minutes = hour * std::int64_t{60} + minute;
  return GpsTime{ns_of_date(year, month, day) + minutes * 60 * kNsPerSecond} + second;
}

int GpsTime::week() const {
  return static_cast<int>(floor_div(ns, kNsPerWeek));
}

std::int64_t GpsTime::sow_ns() const {
  return ns - floor_div(ns, kNsPerWeek) * kNsPerWeek;
}

double GpsTime::sow_s() const {
  return static_cast<double>(sow_ns()) / 1e9;
}

double GpsTime::day_of_year() const {
  const std::int64_t since_new_year = ns - ns_of_date(calendar(*this).year, 1, 1);
  return 1.0 + static_cast<double>(since_new_year) / static_cast<double>(kNsPerDay);
}

int GpsTime::leap_seconds() const {
  int leap = 0;
  for (const std::int64_t midnight : kLeapMidnights) {
    if (ns < midnight + (leap + 1) * kNsPerSecond) break;
    ++leap;
  }
  return leap;
}

std::string GpsTime::iso(int decimals) const {
  CANYON_CHECK(decimals >= 0 && decimals <= 9, "decimals = ", decimals);
  std::int64_t unit = 1;
  for (int i = decimals; i < 9; ++i) unit *= 10;
  // Rounded before it is split, so that 59.9996 s carries into the minute.
  const GpsTime rounded{floor_div(ns + unit / 2, unit) * unit};
  const CalendarTime c = calendar(rounded);
  const std::int64_t ns_of_second = rounded.ns - floor_div(rounded.ns, kNsPerSecond) * kNsPerSecond;
  char text[64];
  std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d", c.year, c.month, c.day, c.hour, c.minute,
                static_cast<int>(c.second));
  std::string result = text;
  if (decimals > 0) {
    std::snprintf(text, sizeof text, ".%0*lld", decimals, static_cast<long long>(ns_of_second / unit));
    result += text;
  }
  return result;
}

CalendarTime calendar(GpsTime t) {
  const std::int64_t day_number = floor_div(t.ns, kNsPerDay);
  const std::int64_t ns_of_day = t.ns - day_number * kNsPerDay;
  // Inverse of days_from_civil.
  const std::int64_t shifted = day_number + kEpochDay + 719468;
  const std::int64_t era = floor_div(shifted, 146097);
  const std::int64_t day_of_era = shifted - era * 146097;
  const std::int64_t year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146096) / 365;
  const std::int64_t day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t month_from_march = (5 * day_of_year + 2) / 153;
  CalendarTime c{};
  c.day = static_cast<int>(day_of_year - (153 * month_from_march + 2) / 5 + 1);
  c.month = static_cast<int>(month_from_march < 10 ? month_from_march + 3 : month_from_march - 9);
  c.year = static_cast<int>(year_of_era + era * 400 + (c.month <= 2 ? 1 : 0));
  const std::int64_t second_of_day = ns_of_day / kNsPerSecond;
  c.hour = static_cast<int>(second_of_day / 3600);
  c.minute = static_cast<int>(second_of_day / 60 % 60);
  c.second = static_cast<double>(ns_of_day - (second_of_day - second_of_day % 60) * kNsPerSecond) / 1e9;
  return c;
}

GpsTime operator+(GpsTime t, double seconds) {
  CANYON_CHECK(std::abs(seconds) < 9.2e9, "seconds = ", seconds);  // also refuses NaN
  // Whole seconds apart: in one product, beyond 104 days the nanoseconds would not fit a double.
  const double whole = std::floor(seconds);
  const std::int64_t added = static_cast<std::int64_t>(whole) * kNsPerSecond + std::llround((seconds - whole) * 1e9);
  std::int64_t sum = 0;
  CANYON_CHECK(!__builtin_add_overflow(t.ns, added, &sum), "t = ", t.ns, " ns, seconds = ", seconds);
  return {sum};
}

GpsTime operator-(GpsTime t, double seconds) {
  return t + (-seconds);
}

double operator-(GpsTime a, GpsTime b) {
  std::int64_t ns = 0;
  CANYON_CHECK(!__builtin_sub_overflow(a.ns, b.ns, &ns), a.ns, " ns minus ", b.ns, " ns");
  return static_cast<double>(ns) / 1e9;
}

GpsTime tick(GpsTime start, std::int64_t k, double rate_hz) {
  CANYON_CHECK(rate_hz >= 1e-3 && rate_hz <= 1e9, "rate_hz = ", rate_hz);
  CANYON_CHECK(k > -9'000'000'000 && k < 9'000'000'000, "k = ", k);
  // Exact: rate_hz = mantissa * 2^-shift with whole numbers, and k * 1e9 * 2^shift fits 128 bits.
  __extension__ using Wide = __int128;
  int exponent = 0;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(rate_hz, &exponent), 53));
  int shift = 53 - exponent;
  while (mantissa % 2 == 0 && shift > 0) {
    mantissa /= 2;
    --shift;
  }
  const Wide numerator = (Wide{k < 0 ? -k : k} * kNsPerSecond) << shift;
  const Wide magnitude = (2 * numerator + mantissa) / (Wide{2} * mantissa);
  const Wide sum = start.ns + (k < 0 ? -magnitude : magnitude);
  const auto ns = static_cast<std::int64_t>(sum);
  CANYON_CHECK(sum == ns, "sample ", k, " at ", rate_hz, " Hz from ", start.ns, " ns");
  return {ns};
}

namespace {

/// Reads a time text from left to right.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  bool done() const { return rest_.empty(); }
  bool take(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  /// A whole number of `min_digits` to `max_digits` digits.
  bool number(std::size_t min_digits, std::size_t max_digits, int& value) {
    std::size_t n = 0;
    value = 0;
    while (n < rest_.size() && n < max_digits && rest_[n] >= '0' && rest_[n] <= '9')
      value = 10 * value + (rest_[n++] - '0');
    rest_.remove_prefix(n);
    return n >= min_digits;
  }
  /// The digits after a decimal point, if there is one, as nanoseconds; digits past the ninth round.
  bool fraction_ns(std::int64_t& value) {
    value = 0;
    if (!take('.')) return true;
    std::size_t n = 0;
    for (; n < rest_.size() && rest_[n] >= '0' && rest_[n] <= '9'; ++n) {
      if (n < 9) value = 10 * value + (rest_[n] - '0');
      if (n == 9 && rest_[n] >= '5') ++value;
    }
    for (std::size_t i = n; i < 9; ++i) value *= 10;
    rest_.remove_prefix(n);
    return n > 0;
  }

 private:
  std::string_view rest_;
};

bool is_date(int year, int month, int day) {
  if (year < kFirstYear || year > kLastYear || month < 1 || month > 12 || day < 1) return false;
  const std::int64_t next_month = month == 12 ? days_from_civil(year + 1, 1, 1) : days_from_civil(year, month + 1, 1);
  return day <= next_month - days_from_civil(year, month, 1);
}

bool parse_week_sow(std::string_view text, GpsTime& t) {
  Scanner in(text);
  int week = 0;
  int sow_s = 0;
  std::int64_t fraction_ns = 0;
  if (!in.number(1, 5, week) || !in.take(':') || !in.number(1, 6, sow_s) || !in.fraction_ns(fraction_ns) || !in.done())
    return false;
  constexpr int kLastWeek = static_cast<int>(ns_of_date(kLastYear, 12, 31) / kNsPerWeek);
  if (week > kLastWeek || sow_s >= 604800) return false;
  t.ns = week * kNsPerWeek + sow_s * kNsPerSecond + fraction_ns;
  return true;
}

bool parse_iso(std::string_view text, GpsTime& t) {
  Scanner in(text);
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  std::int64_t fraction_ns = 0;
  if (!in.number(4, 4, year) || !in.take('-') || !in.number(2, 2, month) || !in.take('-') || !in.number(2, 2, day))
    return false;
  if (in.take('T') || in.take(' ')) {
    if (!in.number(2, 2, hour) || !in.take(':') || !in.number(2, 2, minute)) return false;
    if (in.take(':') && (!in.number(2, 2, second) || !in.fraction_ns(fraction_ns))) return false;
  }
  const bool utc = in.take('Z');
  if (!in.done() || !is_date(year, month, day) || hour > 23 || minute > 59) return false;
  const std::int64_t minute_ns = ns_of_date(year, month, day) + (hour * std::int64_t{60} + minute) * 60 * kNsPerSecond;
  int leap = 0;
  bool leap_second_follows = false;
  for (const std::int64_t midnight : kLeapMidnights) {
    if (utc && minute_ns >= midnight) ++leap;
    if (utc && minute_ns + 60 * kNsPerSecond == midnight) leap_second_follows = true;
  }
  if (second > (leap_second_follows ? 60 : 59)) return false;
  t.ns = minute_ns + (second + leap) * kNsPerSecond + fraction_ns;
  return t.ns >= 0;
}

}  // namespace

Result<GpsTime> GpsTime::parse(std::string_view text, std::string_view origin) {
  GpsTime t;
  if (parse_week_sow(text, t) || parse_iso(text, t)) return t;
  Error error;
  error.file = origin;
  error.what = "\"" + std::string(text) + "\" is not a time";
  error.expected =
      "YYYY-MM-DDTHH:MM:SS (GPS time), the same with a trailing Z (UTC), or WEEK:SECONDS_OF_WEEK, from 1980-01-06 to " +
      std::to_string(kLastYear) + "-12-31";
  return error;
}

}  // namespace canyon
