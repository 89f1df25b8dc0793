#include "canyon/gnss/rinex/record_fields.h"

#include <cmath>

#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {

double RecordFields::number(std::size_t line, std::size_t column, const char* name, bool required) {
  const std::string_view text = columns(record_.lines[line], column, kWidth);
  if (text.empty() && !required) return 0.0;  // RINEX: blank = not known
  const auto value = fortran_number(text);
  if (!value)
    fail(line, text.empty() ? std::string(name) + " is missing" : std::string(name) + " = \"" + printable(text) + "\"",
         text.empty() ? "" : "a number");
  return value.value_or(0.0);
}

double RecordFields::clock(std::size_t index, const char* name) {
  return number(0, record_.clock_column() + index * kWidth, name, true);
}

double RecordFields::orbit(std::size_t line, std::size_t index, const char* name, bool required) {
  return number(line, record_.orbit_column() + index * kWidth, name, required);
}

std::optional<double> RecordFields::known(std::size_t line, std::size_t index, const char* name) {
  if (line >= record_.lines.size()) return std::nullopt;
  const std::size_t column = record_.orbit_column() + index * kWidth;
  if (columns(record_.lines[line], column, kWidth).empty()) return std::nullopt;
  return number(line, column, name, true);
}

GpsTime RecordFields::epoch() {
  const auto t = epoch_of_line(record_.lines.front(), record_.version2);
  require(t.has_value(), 0, "its epoch cannot be read", "year month day hour minute second");
  return t.value_or(GpsTime{});
}

void RecordFields::require(bool condition, std::size_t line, const std::string& what, const std::string& expected) {
  if (!condition) fail(line, what, expected);
}

void RecordFields::fail(std::size_t line, const std::string& what, const std::string& expected) {
  if (!ok_) return;
  ok_ = false;
  error_ = Error{record_.file, record_.first_line + static_cast<int>(line), "", who_ + ": " + what, expected};
}

std::optional<int> satellite_number(const RecordLines& record) {
  const auto prn = whole_number(columns(record.lines.front(), record.version2 ? 0 : 1, 2));
  return prn && *prn >= 1 && *prn <= 63 ? prn : std::nullopt;
}

std::optional<GpsTime> epoch_of_line(std::string_view line, bool version2) {
  const auto year = whole_number(version2 ? columns(line, 3, 2) : columns(line, 4, 4));
  const std::size_t at = version2 ? 5 : 8;
  const auto month = whole_number(columns(line, at, 3)), day = whole_number(columns(line, at + 3, 3));
  const auto hour = whole_number(columns(line, at + 6, 3)), minute = whole_number(columns(line, at + 9, 3));
  const auto second = fortran_number(version2 ? columns(line, 17, 5) : columns(line, 20, 3));
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const int full_year = version2 ? *year + (*year < 80 ? 2000 : 1900) : *year;
  return time_of_fields(full_year, *month, *day, *hour, *minute, *second);
}

GpsTime nearest_with_sow(double sow_s, GpsTime near) {
  return near + std::remainder(sow_s - near.sow_s(), kSecondsPerWeek);
}

}  // namespace canyon::gnss
