#include "canyon/inertial/imu_log.h"

#include <limits>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/tables/column_names.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/log/log_checks.h"
#include "canyon/inertial/log/log_columns.h"

namespace canyon::inertial {
namespace {

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

/// A sensor's increment covers its own sample interval: what a host stamps late, and what a gap has lost, is not in it.
void to_rates(double interval_s, ImuLog& log) {
  for (std::size_t c = 0; c < 6; ++c)
    if (log.increments[c / 3])
      for (double& x : log.channels[c]) x /= interval_s;
}

}  // namespace

Result<ImuLog> read_imu_log(const std::string& path, const ImuLogFormat& format) {
  CANYON_TRY(std::string text, read_text_or_gzip_file(path));
  LineReader in(path, std::move(text));
  std::vector<LogColumn> columns;
  if (!format.columns.empty()) {
    CANYON_TRY(columns, asked_columns(format));
  }
  ImuLog log;
  Places places{path, {}};
  std::vector<std::string_view> fields;
  std::string_view line;
  const bool a_layout = find_model(imu_log_layouts(), format.columns) != nullptr;
  bool named_units = !format.columns.empty() && !a_layout;
  for (bool first = true; in.next(line); first = false) {
    if (log.size() % kSamplesPerLook == 0) throw_if_cancelled();
    if (first && is_header_line(line)) {
      if (!columns.empty()) continue;  // --columns stands for it
      CANYON_TRY(columns, log_columns(line, in.error("", "")));
      named_units = line.find("field.") == std::string_view::npos;  // rostopic's names have none
      CANYON_TRY_STATUS(check_columns(columns, format.rate_hz, in.error("", "")));
      continue;
    }
    if (columns.empty())
      return in.error("no header", "a header of names, or --columns with names or a layout: " + layout_names());
    const bool commas = line.find(',') != std::string_view::npos;
    split(line, commas ? "," : " \t;", !commas, fields);
    if (format.mend && says_nothing(columns, fields)) {
      log.passed_over.not_finite.add(in.number(), kNoTime, log.t_s.empty() ? kNoTime : log.t_s.back());
      continue;
    }
    std::array<double, 6> values{};
    double t_s = format.rate_hz > 0.0 ? static_cast<double>(log.t_s.size()) / format.rate_hz : 0.0;
    for (const LogColumn& column : columns) {
      if (column.field >= fields.size())
        return in.error(std::to_string(fields.size()) + " fields", std::to_string(column.field + 1) + " or more");
      if (column.target == 0 && format.rate_hz > 0.0) continue;
      CANYON_TRY(const double value, parse_number(in, fields[column.field]));
      (column.target > 0 ? values[static_cast<std::size_t>(column.target - 1)] : t_s) = value * column.factor;
    }
    if (!log.t_s.empty() && !(log.t_s.back() < t_s)) {
      if (!format.mend) return in.error("time does not increase", "samples in the order of time");
      const bool same = t_s == log.t_s.back();
      (same ? log.passed_over.duplicates : log.passed_over.reversed).add(in.number(), t_s, log.t_s.back());
      // Of two in the wrong order the one ahead goes: one stamp of the far future must not end the log.
      if (same || log.size() < 2 || !(log.t_s[log.size() - 2] < t_s)) continue;
      log.t_s.pop_back();
      places.lines.pop_back();
      for (auto& channel : log.channels)
        if (!channel.empty()) channel.pop_back();
    }
    log.t_s.push_back(t_s);
    for (const LogColumn& column : columns)
      if (column.target > 0) {
        const auto c = static_cast<std::size_t>(column.target - 1);
        log.channels[c].push_back(values[c]);
      }
    places.lines.push_back(in.number());
  }
  if (log.size() < 2) return in.empty_file(log.size() == 1 ? "second sample" : "samples");
  for (const LogColumn& column : columns)
    if (column.increment) log.increments[static_cast<std::size_t>(column.target - 1) / 3] = true;
  const double interval_s = sampling_of(log.t_s).interval_s;
  CANYON_TRY_STATUS(check_times(log, interval_s, places));
  to_rates(interval_s, log);
  CANYON_TRY_STATUS(check_range(log, places));
  CANYON_TRY_STATUS(check_magnitudes(log, {places, named_units, interval_s}));
  if (format.live) CANYON_TRY_STATUS(check_live(log, places));
  log.lines = std::move(places.lines);
  return log;
}

}  // namespace canyon::inertial
