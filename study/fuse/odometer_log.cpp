#include <array>
#include <cmath>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/tables/column_names.h"
#include "canyon/study/fuse/fix_log.h"

namespace canyon::study {
namespace {

enum Target { kWeek, kTime, kSpeed, kTicks, kInterval, kTargets };
constexpr KnownColumn kColumns[] = {
    {"gps_week", Quantity::kPlain, kWeek}, {"week", Quantity::kPlain, kWeek},   {"sow", Quantity::kTime, kTime},
    {"t", Quantity::kTime, kTime},         {"time", Quantity::kTime, kTime},    {"speed", Quantity::kSpeed, kSpeed},
    {"v", Quantity::kSpeed, kSpeed},       {"ticks", Quantity::kPlain, kTicks}, {"dt", Quantity::kTime, kInterval},
};
constexpr const char* kExpected = "columns t_s (or sow) and speed_m_s or ticks";

using Places = std::array<const PlacedColumn*, kTargets>;

Result<double> number(const LineReader& in, const std::vector<std::string_view>& fields, const PlacedColumn* column) {
  if (column == nullptr) return std::nan("");
  if (column->field >= fields.size())
    return in.error(std::to_string(fields.size()) + " fields", std::to_string(column->field + 1) + " or more");
  const std::string_view field = trimmed(fields[column->field]);
  if (field.empty() || field == "nan" || field == "NaN") return std::nan("");
  CANYON_TRY(const double value, parse_number(in, field));
  return value * column->factor;
}

Result<GpsTime> instant(const LineReader& in, const std::vector<std::string_view>& fields, const Places& at) {
  CANYON_TRY(const double t_s, number(in, fields, at[kTime]));
  if (!(std::abs(t_s) < 9.2e9)) return in.error("no time", "seconds");
  double week = 0.0;
  if (at[kWeek] != nullptr) {
    CANYON_TRY(week, number(in, fields, at[kWeek]));
    if (!(week >= 0.0 && week <= 14000.0) || week != std::floor(week))
      return in.error("no GPS week", "a whole number from 0 to 14000");
  }
  std::int64_t ns = (GpsTime{} + t_s).ns;
  if (at[kTime]->factor == 1.0) {
    CANYON_TRY(ns, parse_seconds(in, fields[at[kTime]->field]));
  }
  return gps_instant(in, static_cast<int>(week), ns);
}

}  // namespace

Result<OdometerLog> read_odometer_log(const std::string& path, const FuseOdometerConfig& config) {
  CANYON_TRY(std::string content, read_text_or_gzip_file(path));
  LineReader in(path, std::move(content));
  std::vector<PlacedColumn> columns;
  Places at{};
  const auto place = [&](const std::string& names) -> Status {
    CANYON_TRY(columns, place_columns(split(names, ",", false), kColumns, in.error("", "")));
    for (const PlacedColumn& column : columns) at[static_cast<std::size_t>(column.target)] = &column;
    if (at[kTime] != nullptr && (at[kSpeed] != nullptr || at[kTicks] != nullptr)) return Ok{};
    return in.error("no time, or neither speed nor ticks, among the columns", kExpected);
  };
  if (!config.columns.empty()) CANYON_TRY_STATUS(place(config.columns));
  OdometerLog out;
  std::vector<std::string_view> fields;
  std::string_view line;
  GpsTime before;
  for (bool first = true, any = false; in.next(line); first = false) {
    const bool commas = line.find(',') != std::string_view::npos;
    split(line, commas ? "," : " \t;", !commas, fields);
    if (first && is_header_line(line)) {
      std::string names;
      for (const std::string_view field : fields) names += (names.empty() ? "" : ",") + std::string(field);
      if (columns.empty()) CANYON_TRY_STATUS(place(names));
      continue;
    }
    if (columns.empty()) return in.error("no header", std::string("a header, or odometer.columns: ") + kExpected);
    CANYON_TRY(const GpsTime t, instant(in, fields, at));
    CANYON_TRY(const double speed, number(in, fields, at[kSpeed]));
    CANYON_TRY(const double ticks, number(in, fields, at[kTicks]));
    CANYON_TRY(double dt_s, number(in, fields, at[kInterval]));
    const bool later = !any || before < t;
    if (!later) ++(before == t ? out.passed_over.duplicates : out.passed_over.reversed);
    if (!later) continue;
    if (!(dt_s > 0.0)) dt_s = any ? t - before : std::nan("");
    any = true;
    before = t;
    OdometerSample sample{.t = t, .dt_s = dt_s, .ticks = 0, .speed_m_s = speed};
    if (at[kTicks] != nullptr && std::abs(ticks) < 9e15) sample.ticks = static_cast<std::int64_t>(ticks);
    if (at[kSpeed] == nullptr) sample.speed_m_s = ticks * config.tick_m / dt_s;
    if (std::isfinite(sample.speed_m_s) && std::isfinite(dt_s))
      out.samples.push_back(sample);
    else if (!std::isnan(dt_s))  // the first line has no interval of its own
      ++out.passed_over.not_finite;
  }
  if (out.samples.empty()) return in.empty_file("speeds");
  out.has_week = at[kWeek] != nullptr;
  return out;
}

}  // namespace canyon::study
