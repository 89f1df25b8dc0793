#include "canyon/core/files/line_reader.h"

#include <charconv>
#include <cmath>

namespace canyon {

std::vector<std::string_view> split(std::string_view line, std::string_view separators, bool join_separators) {
  std::vector<std::string_view> fields;
  split(line, separators, join_separators, fields);
  return fields;
}

void split(std::string_view line, std::string_view separators, bool join_separators,
           std::vector<std::string_view>& fields) {
  fields.clear();
  const auto separates = [separators](char c) {
    for (const char s : separators)
      if (c == s) return true;
    return false;
  };
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && !separates(line[i])) continue;
    if (!join_separators || i > begin) fields.push_back(line.substr(begin, i - begin));
    begin = i + 1;
  }
}

std::string_view trimmed(std::string_view field) {
  while (!field.empty() && (field.front() == ' ' || field.front() == '\t')) field.remove_prefix(1);
  while (!field.empty() && (field.back() == ' ' || field.back() == '\t')) field.remove_suffix(1);
  return field;
}

Result<double> parse_number(const LineReader& in, std::string_view field) {
  const std::string_view text = trimmed(field);
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || status != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return in.error("\"" + std::string(field) + "\" is not a finite number", "a number");
  }
  return value;
}

Result<std::int64_t> parse_seconds(const LineReader& in, std::string_view field) {
  CANYON_TRY(const double seconds, parse_number(in, field));
  if (std::abs(seconds) >= 9.2e9)
    return in.error("\"" + std::string(field) + "\" is not a time", "seconds since the GPS epoch");
  const std::string_view text = trimmed(field);
  const std::size_t point = text.find('.');
  std::int64_t whole = 0;
  const std::string_view before = text.substr(0, point);
  const auto [end, status] = std::from_chars(before.data(), before.data() + before.size(), whole);
  const bool plain = status == std::errc{} && end == before.data() + before.size() && text.front() != '-';
  const std::string_view after = point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);
  if (!plain || after.find_first_not_of("0123456789") != std::string_view::npos) return (GpsTime{} + seconds).ns;
  std::int64_t fraction = 0;
  for (std::size_t i = 0; i < 9; ++i) fraction = 10 * fraction + (i < after.size() ? after[i] - '0' : 0);
  if (after.size() > 9 && after[9] >= '5') ++fraction;
  return whole * kNsPerSecond + fraction;
}

namespace {

Result<double> parse_within(const LineReader& in, std::string_view field, double limit, const char* expected) {
  CANYON_TRY(const double value, parse_number(in, field));
  if (std::abs(value) > limit) return in.error("\"" + std::string(trimmed(field)) + "\" is out of range", expected);
  return value;
}

}  // namespace

Result<double> parse_coordinate(const LineReader& in, std::string_view field) {
  return parse_within(in, field, 1e9, "metres from -1e9 to 1e9");
}

Result<double> parse_speed(const LineReader& in, std::string_view field) {
  return parse_within(in, field, 3e8, "m/s from -3e8 to 3e8");
}

Result<GpsTime> gps_instant(const LineReader& in, int week, std::int64_t sow_ns) {
  GpsTime t;
  if (__builtin_add_overflow(GpsTime::from_week_sow(week, 0.0).ns, sow_ns, &t.ns))
    return in.error("a time beyond the year 2272", "a GPS week from 0 to 14000 and the seconds of it");
  return t;
}

Status check_time_order(const LineReader& in, GpsTime first, GpsTime last, GpsTime t, const char* expected) {
  if (!(last < t)) return in.error("time does not increase", expected);
  std::int64_t since = 0;
  if (__builtin_sub_overflow(t.ns, first.ns, &since))
    return in.error("more than 292 years after the first line", expected);
  return Ok{};
}

}  // namespace canyon
