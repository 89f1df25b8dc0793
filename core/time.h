#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

#include "canyon/core/result.h"

namespace canyon {

inline constexpr double kSecondsPerWeek = 604800.0;
inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;

/// An instant: integer nanoseconds since the GPS epoch (1980-01-06 00:00:00), GPS time (no leap seconds).
struct GpsTime {
  std::int64_t ns = 0;

  /// Throws beyond year 2272.
  static GpsTime from_week_sow(int week, double sow_s);
  /// Calendar date in GPS time; `second` may carry a fraction. Valid 1980-2261.
  static GpsTime from_calendar(int year, int month, int day, int hour, int minute, double second);
  /// Bare ISO 8601 = GPS time, trailing Z = UTC, WEEK:SOW accepted. `origin` names the option in an error.
  static Result<GpsTime> parse(std::string_view text, std::string_view origin);

  int week() const;
  double sow_s() const;                     ///< seconds of week, [0, 604800)
  std::int64_t sow_ns() const;              ///< nanoseconds of week, exact
  double day_of_year() const;               ///< 1.0 = 1 January 00:00 GPS time
  int leap_seconds() const;                 ///< GPS minus UTC at this instant, s
  std::string iso(int decimals = 3) const;  ///< "2010-07-01T13:00:00.000", GPS time

  auto operator<=>(const GpsTime&) const = default;
};

struct CalendarTime {
  int year, month, day, hour, minute;
  double second;
};

/// Calendar fields in GPS time. For UTC pass t minus leap_seconds().
CalendarTime calendar(GpsTime t);

/// t plus a duration in seconds, rounded to the nearest nanosecond. A duration that is not finite, or leaves the range
/// of 64 bits (year 2272), throws.
GpsTime operator+(GpsTime t, double seconds);
GpsTime operator-(GpsTime t, double seconds);
/// a - b in seconds; exact to 1 ns for |a - b| < 104 days. Throws where it leaves the range of 64 bits of nanoseconds.
double operator-(GpsTime a, GpsTime b);

/// Instant of sample k of a sensor with that rate, from `start`: round(k * 1e9 / rate_hz) ns, never accumulated. Throws
/// for an instant beyond year 2272.
GpsTime tick(GpsTime start, std::int64_t k, double rate_hz);

}  // namespace canyon
