#include "canyon/inertial/imu_log.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/deviation.h"

namespace canyon::inertial {
namespace {

constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop
constexpr const char* kExpectedNames =
    "t_s or --rate, and channels such as gx_rad_s, gy_deg_s, az_m_s2, ax_g, with *FACTOR for counts";

constexpr ImuLogLayout kLayouts[] = {
    {"euroc", "t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2", "EuRoC and TUM-VI data sets"},
    {"kf_gins", "t_s,gx_rad,gy_rad*-1,gz_rad*-1,ax_m_s,ay_m_s*-1,az_m_s*-1",
     "KF-GINS text: increments, turned from front-right-down to front-left-up"},
};

/// Names that other programs write.
struct Alias {
  const char* theirs;
  const char* ours;
};
constexpr Alias kAliases[] = {
    {"field.header.stamp", "t_ns"},  // rostopic echo -p of sensor_msgs/Imu
    {"field.angular_velocity.x", "gx_rad_s"},
    {"field.angular_velocity.y", "gy_rad_s"},
    {"field.angular_velocity.z", "gz_rad_s"},
    {"field.linear_acceleration.x", "ax_m_s2"},
    {"field.linear_acceleration.y", "ay_m_s2"},
    {"field.linear_acceleration.z", "az_m_s2"},
    {"timestamp [ns]", "t_ns"},  // EuRoC's names, where they are not behind a #
    {"w_RS_S_x [rad s^-1]", "gx_rad_s"},
    {"w_RS_S_y [rad s^-1]", "gy_rad_s"},
    {"w_RS_S_z [rad s^-1]", "gz_rad_s"},
    {"a_RS_S_x [m s^-2]", "ax_m_s2"},
    {"a_RS_S_y [m s^-2]", "ay_m_s2"},
    {"a_RS_S_z [m s^-2]", "az_m_s2"},
};

struct Unit {
  const char* suffix;
  char quantity;  ///< t, g or a
  double si;
  bool increment = false;
};
constexpr Unit kUnits[] = {
    {"s", 't', 1.0},         {"ms", 't', 1e-3},           {"us", 't', 1e-6},     {"ns", 't', 1e-9},
    {"rad_s", 'g', 1.0},     {"deg_s", 'g', kDegree},     {"dps", 'g', kDegree}, {"deg_h", 'g', kDegree / 3600.0},
    {"rad", 'g', 1.0, true}, {"deg", 'g', kDegree, true}, {"m_s2", 'a', 1.0},    {"g", 'a', kStandardGravity},
    {"mg", 'a', kMilliG},    {"m_s", 'a', 1.0, true},
};

/// Where a column goes: 0 time, 1..6 channels.
struct Column {
  std::size_t field = 0;
  int target = 0;
  double factor = 1.0;
  bool increment = false;
};

/// 0 time, 1..6 channels, -1 for names that mean nothing here.
int target_of(std::string_view channel) {
  if (channel == "t") return 0;
  for (int c = 0; c < 6; ++c)
    if (channel == kChannelNames[c]) return c + 1;
  return -1;
}

/// nullopt for names that mean nothing here.
Result<std::optional<Column>> column_of(std::string_view name, std::size_t field, const Error& at) {
  name = trimmed(name);
  for (const Alias& alias : kAliases)
    if (name == alias.theirs) name = alias.ours;
  const std::string_view whole = name;
  const std::size_t star = name.find('*');
  name = trimmed(name.substr(0, star));
  const std::size_t underscore = name.find('_');
  const int target = target_of(name.substr(0, underscore));
  if (target < 0) return std::optional<Column>{};
  Error error = at;
  error.what = "column \"" + std::string(whole) + "\": ";
  error.expected = kExpectedNames;
  double factor = 1.0;
  if (star != std::string_view::npos) {
    const std::string_view number = trimmed(whole.substr(star + 1));
    const auto [stop, status] = std::from_chars(number.data(), number.data() + number.size(), factor);
    if (status != std::errc() || stop != number.data() + number.size() || !std::isfinite(factor) || factor == 0.0) {
      error.what += "no factor";
      return error;
    }
  }
  const char quantity = target == 0 ? 't' : target <= 3 ? 'g' : 'a';
  if (underscore != std::string_view::npos)
    for (const Unit& unit : kUnits)
      if (name.substr(underscore + 1) == unit.suffix && unit.quantity == quantity)
        return std::optional<Column>(Column{field, target, unit.si * factor, unit.increment});
  error.what += "no such unit";
  return error;
}

Result<std::vector<Column>> columns_of(std::string_view names, const Error& at) {
  std::vector<Column> out;
  const auto fields = split(names, ",", false);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    CANYON_TRY(const std::optional<Column> column, column_of(fields[i], i, at));
    if (column) out.push_back(*column);
  }
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
  for (int target = 1; target <= 6; ++target) {
    const int triad = (target - 1) / 3;
    const auto named = [&](int t) { return count([t](const Column& c) { return c.target == t; }) > 0; };
    if (named(target) || !(named(3 * triad + 1) || named(3 * triad + 2) || named(3 * triad + 3))) continue;
    error.what = std::string("no column for ") + kChannelNames[target - 1];
    return error;
  }
  for (const int first : {1, 4}) {
    const auto of_triad = [&](bool increment) {
      return count(
          [&](const Column& c) { return c.target >= first && c.target < first + 3 && c.increment == increment; });
    };
    if (of_triad(true) == 0 || of_triad(false) == 0) continue;
    error.what = first == 1 ? "rates and increments in one gyroscope" : "rates and increments in one accelerometer";
    error.expected = "one of the two";
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

/// Where the log's samples stand in the file, for messages.
struct Places {
  std::string path;
  std::vector<int> lines;

  Error error(std::size_t sample, std::string what, std::string expected) const {
    return {path, lines[sample], "", std::move(what), std::move(expected)};
  }
};

std::string text(const char* format, auto... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

/// A sensor's noise never lets it stay at its largest value; a full scale does.
Status check_saturation(const ImuLog& log, int channel, const Places& places) {
  constexpr std::size_t kLongest = 5;          // samples in a row
  constexpr std::size_t kDistinctValues = 16;  // fewer: a sensor of coarse steps, which do stay
  const auto& x = log.channels[static_cast<std::size_t>(channel)];
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  for (const double extreme : {*most, *least}) {
    std::size_t run = 0, longest = 0, end = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      run = x[k] == extreme ? run + 1 : 0;
      if (run > longest) longest = run, end = k;
    }
    if (longest < kLongest) continue;
    std::vector<double> values = x;
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    if (values.size() < kDistinctValues) continue;
    return places.error(end + 1 - longest,
                        text("%s stays at its extreme value %.6g %s for %zu samples: saturated", kChannelNames[channel],
                             extreme, channel < 3 ? "rad/s" : "m/s^2", longest),
                        "a log within the sensor's range");
  }
  return Ok{};
}

Status check_live(const ImuLog& log, const Places& places) {
  for (int c = 0; c < 6; ++c) {
    const auto& x = log.channels[static_cast<std::size_t>(c)];
    if (x.size() <= 10) continue;
    if (std::all_of(x.begin(), x.end(), [&](double v) { return v == x.front(); }))
      return places.error(0, std::string(kChannelNames[c]) + " never changes", "a channel that is alive");
    CANYON_TRY_STATUS(check_saturation(log, c, places));
  }
  return Ok{};
}

/// How the units are judged: what speaks against them is an Error where they are guessed, a doubt where they are named.
struct Judge {
  const Places& places;
  bool named_units;  ///< the header, or --columns, has names with units
  double interval_s;
};

/// So fast that the centripetal force on a unit may be any.
bool turns_fast(const ImuLog& log) {
  constexpr double kFast_rad_s = 5.0;
  if (log.channels[0].empty()) return false;
  double square = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (const double x : log.channels[c]) square += x * x / static_cast<double>(log.size());
  return square > kFast_rad_s * kFast_rad_s;
}

/// The magnitude of the specific force on average: a log that turns, as one of many positions does, has no mean
/// direction.
double mean_force(const ImuLog& log) {
  double force = 0.0;
  for (std::size_t k = 0; k < log.size(); ++k)
    force += std::hypot(log.channels[3][k], log.channels[4][k], log.channels[5][k]) / static_cast<double>(log.size());
  return force;
}
bool near(double value, double expected) {
  return std::abs(value / expected - 1.0) < 0.1;
}

/// What no unit can show on average. `as_increments`: the file is said to hold increments.
Status check_force(ImuLog& log, const Judge& judge, bool as_increments) {
  const double force = mean_force(log), interval_s = judge.interval_s;
  if (near(force, kStandardGravity)) return Ok{};
  const std::string figure = text("mean specific force %.4g m/s^2: ", force);
  if (as_increments) {
    if (near(force, kStandardGravity / interval_s))
      return judge.places.error(0, figure + "these are rates, where increments are said", "names in _m_s2");
    return Ok{};
  }
  struct Mistake {
    double force;
    const char* what;
    const char* expected;
  };
  const Mistake mistakes[] = {
      {kStandardGravity * interval_s, "these are velocity increments, not rates", "names in _m_s"},
      {1.0, "these are g", "names in _g"},
      {1000.0, "these are mg", "names in _mg"},
      {100.0 * kStandardGravity, "these are cm/s^2", "_m_s2*0.01"},
      {kStandardGravity * kStandardGravity, "these are m/s^2", "names in _m_s2"},
  };
  const auto off = [&](const Mistake& m) { return std::abs(force / m.force - 1.0); };
  const Mistake& nearest = *std::min_element(std::begin(mistakes), std::end(mistakes),
                                             [&](const Mistake& a, const Mistake& b) { return off(a) < off(b); });
  if (!near(force, nearest.force)) return Ok{};
  const Error error = judge.places.error(0, figure + nearest.what, nearest.expected);
  if (!judge.named_units || !turns_fast(log)) return error;
  log.doubts.push_back(error.str() + "; taken as named, for the unit turns fast");
  return Ok{};
}

Status check_rates(ImuLog& log, const Judge& judge, bool as_increments) {
  constexpr double kLargest = 100.0;  // rad/s; the fastest gyroscopes on the market end at 70 (4000 deg/s)
  const Places& places = judge.places;
  // Where the accelerometer is of the same kind, gravity has spoken for both.
  const bool same_kind = !log.channels[3].empty() && log.increments[1] == as_increments;
  for (std::size_t c = 0; c < 3 && !(as_increments && same_kind); ++c)
    for (std::size_t k = 0; k < log.channels[c].size(); ++k) {
      if (!(std::abs(log.channels[c][k]) > kLargest)) continue;
      const Error error =
          places.error(k,
                       text("%s = %.4g rad/s: no gyroscope goes so far; these are %s", kChannelNames[c],
                            log.channels[c][k], as_increments ? "rates, where increments are said" : "deg/s"),
                       as_increments ? "names in _rad_s" : "names in _deg_s");
      if (!judge.named_units) return error;
      log.doubts.push_back(text("%s:%d: %s = %.4g rad/s, taken as named: no gyroscope on the market goes so far",
                                places.path.c_str(), places.lines[k], kChannelNames[c], log.channels[c][k]));
      return Ok{};
    }
  // Only the Earth's rate itself tells rates from increments: a MEMS bias may have any size, but hardly just that.
  if (same_kind || log.channels[0].empty()) return Ok{};
  const double rate = std::hypot(mean_of(log.channels[0]), mean_of(log.channels[1]), mean_of(log.channels[2]));
  const double interval_s = judge.interval_s;
  const double mistaken = as_increments ? Wgs84::rate_rad_s / interval_s : Wgs84::rate_rad_s * interval_s;
  if (std::abs(rate / mistaken - 1.0) >= 0.1) return Ok{};
  return places.error(0,
                      as_increments
                          ? text("mean rate %.4g rad/s is the Earth's by the interval: these are rates, where "
                                 "increments are said",
                                 rate)
                          : text("mean rate %.4g rad/s is the Earth's times the interval: these are angle increments, "
                                 "not rates",
                                 rate),
                      as_increments ? "names in _rad_s" : "names in _rad");
}

/// Each triad by itself: a file may hold rates of one and increments of the other.
Status check_magnitudes(ImuLog& log, const Judge& judge) {
  if (!log.channels[3].empty()) CANYON_TRY_STATUS(check_force(log, judge, log.increments[1]));
  return check_rates(log, judge, log.increments[0]);
}

/// Beyond these, numbers are no measurements of anything, and their squares leave the range of numbers.
Status check_range(const ImuLog& log, const Places& places) {
  constexpr double kLargest = 1e12;  // rad/s, m/s^2
  for (std::size_t c = 0; c < 6; ++c)
    for (std::size_t k = 0; k < log.channels[c].size(); ++k)
      if (!(std::abs(log.channels[c][k]) <= kLargest))
        return places.error(
            k, text("%s = %.4g %s is out of range", kChannelNames[c], log.channels[c][k], c < 3 ? "rad/s" : "m/s^2"),
            "a rate or force below 1e12");
  return Ok{};
}

/// Intervals that samples can have; times as seconds that are instants.
Status check_times(const ImuLog& log, double interval_s, const Places& places) {
  constexpr double kLatest_s = 9.2e9, kShortest_s = 1e-9;
  for (const std::size_t k : {std::size_t{0}, log.size() - 1})
    if (std::abs(log.t_s[k]) > kLatest_s)
      return places.error(k, text("time %.6g s", log.t_s[k]), "seconds from -9.2e9 to 9.2e9");
  if (interval_s >= kShortest_s) return Ok{};
  return places.error(0, text("samples %.3g s apart", interval_s), "a nanosecond or more; is the time's unit right?");
}

/// A sensor's increment covers its own sample interval: what a host stamps late, and what a gap has lost, is not in it.
void to_rates(double interval_s, ImuLog& log) {
  for (std::size_t c = 0; c < 6; ++c)
    if (log.increments[c / 3])
      for (double& x : log.channels[c]) x /= interval_s;
}

std::string layout_names() {
  std::string out;
  for (const ImuLogLayout& layout : kLayouts) out += (out.empty() ? "" : ", ") + std::string(layout.name);
  return out;
}

Result<std::vector<Column>> asked_columns(const ImuLogFormat& format) {
  std::string names = format.columns;
  for (const ImuLogLayout& layout : kLayouts)
    if (names == layout.name) names = layout.make;
  const Error at{"--columns", 0, "", "", ""};
  CANYON_TRY(auto columns, columns_of(names, at));
  CANYON_TRY_STATUS(check_columns(columns, format.rate_hz, at));
  return columns;
}

}  // namespace

ModelTable<const char*> imu_log_layouts() {
  return kLayouts;
}

Result<ImuLog> read_imu_log(const std::string& path, const ImuLogFormat& format) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  LineReader in(path, text);
  std::vector<Column> columns;
  if (!format.columns.empty()) {
    CANYON_TRY(columns, asked_columns(format));
  }
  ImuLog log;
  Places places{path, {}};
  std::string_view line;
  const bool a_layout = find_model(imu_log_layouts(), format.columns) != nullptr;
  bool named_units = !format.columns.empty() && !a_layout;
  for (bool first = true; in.next(line); first = false) {
    if (log.size() % kSamplesPerLook == 0) throw_if_cancelled();
    if (first && has_letters(line)) {
      if (!columns.empty()) continue;  // --columns stands for it
      CANYON_TRY(columns, columns_of(line, in.error("", "")));
      named_units = line.find("field.") == std::string_view::npos;  // rostopic's names have none
      CANYON_TRY_STATUS(check_columns(columns, format.rate_hz, in.error("", "")));
      continue;
    }
    if (columns.empty())
      return in.error("no header", "a header of names, or --columns with names or a layout: " + layout_names());
    const bool commas = line.find(',') != std::string_view::npos;
    const auto fields = split(line, commas ? "," : " \t;", !commas);
    bool timed = false;
    for (const Column& column : columns) {
      if (column.field >= fields.size())
        return in.error(std::to_string(fields.size()) + " fields", std::to_string(column.field + 1) + " or more");
      if (column.target == 0 && format.rate_hz > 0.0) continue;
      CANYON_TRY(const double value, parse_number(in, fields[column.field]));
      if (column.target > 0) {
        log.channels[static_cast<std::size_t>(column.target - 1)].push_back(value * column.factor);
        continue;
      }
      timed = true;
      log.t_s.push_back(value * column.factor);
    }
    if (!timed) log.t_s.push_back(static_cast<double>(log.t_s.size()) / format.rate_hz);
    if (log.size() >= 2 && !(log.t_s[log.size() - 2] < log.t_s.back()))
      return in.error("time does not increase", "samples in the order of time");
    places.lines.push_back(in.error("", "").line);
  }
  if (log.size() < 2) return in.empty_file(log.size() == 1 ? "second sample" : "samples");
  for (const Column& column : columns)
    if (column.increment) log.increments[static_cast<std::size_t>(column.target - 1) / 3] = true;
  const double interval_s = sampling_of(log.t_s).interval_s;
  CANYON_TRY_STATUS(check_times(log, interval_s, places));
  to_rates(interval_s, log);
  CANYON_TRY_STATUS(check_range(log, places));
  CANYON_TRY_STATUS(check_magnitudes(log, {places, named_units, interval_s}));
  if (format.live) CANYON_TRY_STATUS(check_live(log, places));
  return log;
}

}  // namespace canyon::inertial
