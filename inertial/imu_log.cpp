#include "inertial/imu_log.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/files.h"
#include "core/line_reader.h"
#include "core/units.h"

namespace canyon::inertial {
namespace {

constexpr double kGravity = 9.80665;  // m/s^2
constexpr const char* kExpectedNames =
    "t_s or --rate, and channels such as gx_rad_s, gy_deg_s, az_m_s2, ax_g, with *FACTOR for counts";

struct Unit {
  const char* suffix;
  char quantity;  ///< t, g or a
  double si;
};
constexpr Unit kUnits[] = {
    {"s", 't', 1.0},
    {"ms", 't', 1e-3},
    {"us", 't', 1e-6},
    {"ns", 't', 1e-9},
    {"rad_s", 'g', 1.0},
    {"deg_s", 'g', kDegree},
    {"dps", 'g', kDegree},
    {"deg_h", 'g', kDegree / 3600.0},
    {"m_s2", 'a', 1.0},
    {"g", 'a', kGravity},
    {"mg", 'a', kGravity * 1e-3},
};

/// Where a column goes: 0 time, 1..6 channels.
struct Column {
  std::size_t field = 0;
  int target = 0;
  double factor = 1.0;
};

/// nullopt for names that mean nothing here.
std::optional<Column> column_of(std::string_view name, std::size_t field) {
  name = trimmed(name);
  double factor = 1.0;
  if (const std::size_t star = name.find('*'); star != std::string_view::npos) {
    const std::string_view number = trimmed(name.substr(star + 1));
    const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), factor);
    if (error != std::errc() || stop != number.data() + number.size() || !std::isfinite(factor) || factor == 0.0)
      return std::nullopt;
    name = trimmed(name.substr(0, star));
  }
  const std::size_t underscore = name.find('_');
  if (underscore == std::string_view::npos) return std::nullopt;
  const std::string_view channel = name.substr(0, underscore), suffix = name.substr(underscore + 1);
  int target = -1;
  if (channel == "t") target = 0;
  for (int c = 0; c < 6; ++c)
    if (channel == kChannelNames[c]) target = c + 1;
  if (target < 0) return std::nullopt;
  const char quantity = target == 0 ? 't' : target <= 3 ? 'g' : 'a';
  for (const Unit& unit : kUnits)
    if (suffix == unit.suffix && unit.quantity == quantity) return Column{field, target, unit.si * factor};
  return std::nullopt;
}

std::vector<Column> columns_of(std::string_view names) {
  std::vector<Column> out;
  const auto fields = split(names, ",", false);
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (const auto column = column_of(fields[i], i)) out.push_back(*column);
  return out;
}

bool has_letters(std::string_view line) {
  return line.find_first_of("abcdfghijklmnopqrstuvwxyzABCDFGHIJKLMNOPQRSTUVWXYZ_") != std::string_view::npos;
}

Status check_columns(const std::vector<Column>& columns, double rate_hz, const Error& at) {
  const auto count = [&](auto test) { return std::count_if(columns.begin(), columns.end(), test); };
  Error error = at;
  error.expected = kExpectedNames;
  if (count([](const Column& c) { return c.target > 0; }) == 0) {
    error.what = "no column of an IMU";
    return error;
  }
  if (rate_hz <= 0.0 && count([](const Column& c) { return c.target == 0; }) == 0) {
    error.what = "no time column";
    return error;
  }
  for (int target = 0; target <= 6; ++target)
    if (count([&](const Column& c) { return c.target == target; }) > 1) {
      error.what = std::string("two columns for ") + (target == 0 ? "t" : kChannelNames[target - 1]);
      error.expected = "one";
      return error;
    }
  return Ok{};
}

double mean_of(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

/// What a resting or driving unit cannot show.
Status check_magnitudes(const std::string& path, const ImuLog& log) {
  const auto complain = [&](std::string what, std::string expected) {
    return Error{path, 0, "", std::move(what), std::move(expected)};
  };
  for (int c = 0; c < 6; ++c) {
    const auto& x = log.channels[static_cast<std::size_t>(c)];
    if (x.size() > 10 && std::all_of(x.begin(), x.end(), [&](double v) { return v == x.front(); }))
      return complain(std::string(kChannelNames[c]) + " never changes", "a channel that is alive");
  }
  const auto& ax = log.channels[3];
  const auto& ay = log.channels[4];
  const auto& az = log.channels[5];
  if (ax.empty() || ay.empty() || az.empty()) return Ok{};
  const double force = std::hypot(mean_of(ax), mean_of(ay), mean_of(az));
  const double interval_s = (log.t_s.back() - log.t_s.front()) / static_cast<double>(log.size() - 1);
  const auto near = [&](double expected) { return std::abs(force / expected - 1.0) < 0.1; };
  if (near(kGravity)) return Ok{};
  char figure[64];
  std::snprintf(figure, sizeof figure, "mean specific force %.4g m/s^2", force);
  if (near(kGravity * interval_s))
    return complain(std::string(figure) + ": these are velocity increments, not rates",
                    "m/s^2; divide by the interval with *FACTOR");
  if (near(1.0)) return complain(std::string(figure) + ": these are g", "names in _g");
  if (near(1000.0)) return complain(std::string(figure) + ": these are mg", "names in _mg");
  if (near(100.0 * kGravity)) return complain(std::string(figure) + ": these are cm/s^2", "_m_s2*0.01");
  if (near(kGravity * kGravity)) return complain(std::string(figure) + ": these are m/s^2", "names in _m_s2");
  return Ok{};
}

}  // namespace

Result<ImuLog> read_imu_log(const std::string& path, const ImuLogFormat& format) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  LineReader in(path, text);
  std::vector<Column> columns;
  if (!format.columns.empty()) {
    columns = columns_of(format.columns);
    CANYON_TRY_STATUS(check_columns(columns, format.rate_hz, {"--columns", 0, "", "", ""}));
  }
  ImuLog log;
  std::string_view line;
  for (bool first = true; in.next(line); first = false) {
    if (first && has_letters(line)) {
      if (!columns.empty()) continue;  // --columns stands for it
      columns = columns_of(line);
      CANYON_TRY_STATUS(check_columns(columns, format.rate_hz, in.error("", "")));
      continue;
    }
    if (columns.empty()) return in.error("no header", "a header of names, or --columns");
    const bool commas = line.find(',') != std::string_view::npos;
    const auto fields = split(line, commas ? "," : " \t;", !commas);
    bool timed = false;
    for (const Column& column : columns) {
      if (column.field >= fields.size())
        return in.error(std::to_string(fields.size()) + " fields", std::to_string(column.field + 1) + " or more");
      CANYON_TRY(const double value, parse_number(in, fields[column.field]));
      if (column.target > 0) {
        log.channels[static_cast<std::size_t>(column.target - 1)].push_back(value * column.factor);
        continue;
      }
      timed = true;
      log.t_s.push_back(value * column.factor);
    }
    const std::size_t n = std::max_element(log.channels.begin(), log.channels.end(), [](const auto& a, const auto& b) {
                            return a.size() < b.size();
                          })->size();
    if (!timed) log.t_s.push_back(static_cast<double>(n - 1) / format.rate_hz);
    if (log.t_s.size() >= 2 && !(log.t_s[log.t_s.size() - 2] < log.t_s.back()))
      return in.error("time does not increase", "samples in the order of time");
  }
  if (log.size() < 2) return in.empty_file(log.size() == 1 ? "second sample" : "samples");
  CANYON_TRY_STATUS(check_magnitudes(path, log));
  return log;
}

}  // namespace canyon::inertial
