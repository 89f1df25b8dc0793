#include "canyon/study/fuse/logs/timed_log.h"

#include <cmath>

#include "canyon/core/files/files.h"

namespace canyon::study {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Result<TimedLog> TimedLog::open(const std::string& path, TimedLogLayout layout) {
  CANYON_TRY(std::string text, read_text_or_gzip_file(path));
  return TimedLog(path, std::move(text), std::move(layout));
}

Status TimedLog::place(const std::string& names) {
  CANYON_TRY(const auto columns, place_columns(split(names, ",", false), layout_.columns, in_.error("", "")));
  for (const PlacedColumn& column : columns)
    places_[static_cast<std::size_t>(column.target)] = {true, column.field, column.factor};
  placed_ = true;
  const char* lacks = !has(TimedLogLayout::kTime) ? "no time" : lacking != nullptr ? lacking(*this) : nullptr;
  if (lacks != nullptr) return in_.error(std::string(lacks) + " among the columns", layout_.expected);
  return Ok{};
}

Result<double> TimedLog::number(int target) const {
  const Place& at = places_[static_cast<std::size_t>(target)];
  if (!at.there) return kNone;
  if (at.field >= fields_.size())
    return in_.error(std::to_string(fields_.size()) + " fields", std::to_string(at.field + 1) + " or more");
  const std::string_view field = trimmed(fields_[at.field]);
  if (field.empty() || field == "nan" || field == "NaN") return kNone;
  CANYON_TRY(const double value, parse_number(in_, field));
  return value * at.factor;
}

Result<GpsTime> TimedLog::instant() const {
  CANYON_TRY(const double t_s, number(TimedLogLayout::kTime));
  if (!(std::abs(t_s) < 9.2e9)) return in_.error("no time", "seconds");
  double week = 0.0;
  if (has_week()) {
    CANYON_TRY(week, number(TimedLogLayout::kWeek));
    if (!(week >= 0.0 && week <= 14000.0) || week != std::floor(week))
      return in_.error("no GPS week", "a whole number from 0 to 14000");
  }
  std::int64_t ns = (GpsTime{} + t_s).ns;
  if (const Place& at = places_[TimedLogLayout::kTime]; at.factor == 1.0) {
    CANYON_TRY(ns, parse_seconds(in_, fields_[at.field]));
  }
  return gps_instant(in_, static_cast<int>(week), ns);
}

Result<bool> TimedLog::next() {
  if (first_ && !layout_.columns_given.empty()) CANYON_TRY_STATUS(place(layout_.columns_given));
  for (std::string_view line; in_.next(line);) {
    const bool commas = line.find(',') != std::string_view::npos;
    split(line, commas ? "," : " \t;", !commas, fields_);
    const bool header = first_ && is_header_line(line);
    first_ = false;
    if (header) {
      std::string names;
      for (const std::string_view field : fields_) names += (names.empty() ? "" : ",") + std::string(field);
      if (!placed_) CANYON_TRY_STATUS(place(names));
      continue;
    }
    if (!placed_) return in_.error("no header", std::string("a header, or ") + layout_.key + ": " + layout_.expected);
    CANYON_TRY(const GpsTime t, instant());
    latest_s_ = any_ ? stated_s(t_) : kNone;
    if (any_ && !(t_ < t)) {
      (t_ == t ? passed_over_.duplicates : passed_over_.reversed).add(in_.number(), stated_s(t), latest_s_);
      continue;
    }
    since_s_ = any_ ? t - t_ : kNone;
    any_ = true;
    t_ = t;
    return true;
  }
  return false;
}

}  // namespace canyon::study
