#pragma once

#include <optional>
#include <string_view>

#include "canyon/core/time.h"

namespace canyon::gnss {

/// Whether a year of 1980-2200 has that day.
bool is_date(int year, int month, int day);

/// The instant of calendar fields, counted as if they were GPS time; nullopt if they are no date and time of 1980-2200.
std::optional<GpsTime> time_of_fields(int year, int month, int day, int hour, int minute, double second);

/// `year month day hour minute second`, separated by blanks.
std::optional<GpsTime> time_of_words(std::string_view text);

/// GPS time of an instant of UTC that was counted as if it were GPS time, by the table of leap seconds. The label
/// 23:59:60 counts as 00:00:00; `second_60` tells the two apart.
GpsTime gps_time_of_utc(GpsTime utc_as_gps, bool second_60 = false);

}  // namespace canyon::gnss
