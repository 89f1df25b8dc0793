#include "canyon/gnss/rinex/calendar_fields.h"

#include <array>

#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {

bool is_date(int year, int month, int day) {
  if (year < 1980 || year > 2200 || month < 1 || month > 12 || day < 1 || day > 31) return false;
  return calendar(GpsTime::from_calendar(year, month, day, 0, 0, 0.0)).day == day;
}

std::optional<GpsTime> time_of_fields(int year, int month, int day, int hour, int minute, double second) {
  if (!is_date(year, month, day) || hour < 0 || hour > 24 || minute < 0 || minute > 59 ||
      !(second >= 0.0 && second < 61.0))
    return std::nullopt;
  return GpsTime::from_calendar(year, month, day, hour, minute, second);
}

std::optional<GpsTime> time_of_words(std::string_view text) {
  std::array<int, 5> whole{};
  for (int& value : whole) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const std::size_t end = std::min(text.find(' '), text.size());
    const auto number = whole_number(text.substr(0, end));
    if (!number) return std::nullopt;
    value = *number;
    text.remove_prefix(end);
  }
  const auto second = fortran_number(columns(text, 0, text.size()));
  if (!second) return std::nullopt;
  return time_of_fields(whole[0], whole[1], whole[2], whole[3], whole[4], *second);
}

GpsTime gps_time_of_utc(GpsTime utc_as_gps, bool second_60) {
  // GpsTime::leap_seconds() counts at instants of GPS time, which is ahead of UTC by what it says; one second more, so
  // that midnight itself already has the new number.
  const auto leap = [](GpsTime utc) { return (utc + (utc.leap_seconds() + 1.0)).leap_seconds(); };
  // In a leap second the number before it still holds.
  return utc_as_gps + static_cast<double>(leap(second_60 ? utc_as_gps - 1.0 : utc_as_gps));
}

}  // namespace canyon::gnss
