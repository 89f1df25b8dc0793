#include "canyon/inertial/log/log_columns.h"

#include <algorithm>
#include <optional>

#include "canyon/core/files/line_reader.h"
#include "canyon/core/lower_case.h"
#include "canyon/core/tables/column_names.h"

namespace canyon::inertial {
namespace {

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

/// Other names of a channel, and of the time.
struct ChannelName {
  const char* name;
  int target;
};
constexpr ChannelName kChannelWords[] = {
    {"t", 0},     {"time", 0},  {"timestamp", 0}, {"sow", 0},     {"gps_sow", 0}, {"gx", 1},     {"gy", 2},
    {"gz", 3},    {"wx", 1},    {"wy", 2},        {"wz", 3},      {"gyro_x", 1},  {"gyro_y", 2}, {"gyro_z", 3},
    {"ax", 4},    {"ay", 5},    {"az", 6},        {"fx", 4},      {"fy", 5},      {"fz", 6},     {"acc_x", 4},
    {"acc_y", 5}, {"acc_z", 6}, {"accel_x", 4},   {"accel_y", 5}, {"accel_z", 6},
};

/// The channel that a name begins with, and what comes after it.
struct Channel {
  int target = -1;  ///< 0 time, 1..6 channels, -1 for names that mean nothing here
  std::string_view unit;
};
Channel channel_of(std::string_view name) {
  Channel out;
  std::size_t longest = 0;
  for (const ChannelName& word : kChannelWords) {
    const std::string_view its = word.name;
    const bool is = name == its || (name.starts_with(its) && name[its.size()] == '_');
    if (!is || its.size() <= longest) continue;
    longest = its.size();
    out = {word.target, name.substr(std::min(name.size(), its.size() + 1))};
  }
  return out;
}

/// What a unit of a channel makes of its numbers: rates and forces, or increments of them.
struct ChannelUnit {
  double si = 1.0;
  bool increment = false;
};
std::optional<ChannelUnit> channel_unit(int target, std::string_view unit) {
  const auto of = [&](Quantity quantity, bool increment) -> std::optional<ChannelUnit> {
    const auto si = unit_value(quantity, unit);
    return si ? std::optional(ChannelUnit{*si, increment}) : std::nullopt;
  };
  if (target == 0) return of(Quantity::kTime, false);
  const bool gyro = target <= 3;
  const auto rate = of(gyro ? Quantity::kAngularRate : Quantity::kAcceleration, false);
  return rate ? rate : of(gyro ? Quantity::kAngle : Quantity::kSpeed, true);
}

/// nullopt for names that mean nothing here.
Result<std::optional<LogColumn>> column_of(std::string_view name, std::size_t field, const Error& at) {
  name = trimmed(name);
  for (const Alias& alias : kAliases)
    if (name == alias.theirs) name = alias.ours;
  const std::string_view whole = name;
  const std::string lower = lower_case(trimmed(name.substr(0, name.find('*'))));
  const Channel channel = channel_of(lower);
  if (channel.target < 0) return std::optional<LogColumn>{};
  Error error = at;
  error.what = "column \"" + std::string(whole) + "\": ";
  error.expected = kExpectedNames;
  const auto factor = column_factor(whole);
  if (!factor) {
    error.what += "no factor";
    return error;
  }
  // Seconds of week are seconds.
  const bool seconds = channel.unit.empty() && lower.ends_with("sow");
  const auto unit = channel_unit(channel.target, seconds ? std::string_view("s") : channel.unit);
  if (unit) return std::optional<LogColumn>(LogColumn{field, channel.target, unit->si * *factor, unit->increment});
  if (channel.target == 0 && lower != "t" && lower[1] != '_') return std::optional<LogColumn>{};  // a date, say
  error.what += "no such unit";
  return error;
}

}  // namespace

Result<std::vector<LogColumn>> log_columns(std::string_view names, const Error& at) {
  std::vector<LogColumn> out;
  const auto fields = split(names, ",", false);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    CANYON_TRY(const std::optional<LogColumn> column, column_of(fields[i], i, at));
    if (column) out.push_back(*column);
  }
  return out;
}

Status check_columns(const std::vector<LogColumn>& columns, double rate_hz, const Error& at) {
  const auto count = [&](auto test) { return std::count_if(columns.begin(), columns.end(), test); };
  Error error = at;
  error.expected = kExpectedNames;
  if (count([](const LogColumn& c) { return c.target > 0; }) == 0) {
    error.what = "no column of an IMU";
    return error;
  }
  if (rate_hz <= 0.0 && count([](const LogColumn& c) { return c.target == 0; }) == 0) {
    error.what = "no time column";
    return error;
  }
  for (int target = 1; target <= 6; ++target) {
    const int triad = (target - 1) / 3;
    const auto named = [&](int t) { return count([t](const LogColumn& c) { return c.target == t; }) > 0; };
    if (named(target) || !(named(3 * triad + 1) || named(3 * triad + 2) || named(3 * triad + 3))) continue;
    error.what = std::string("no column for ") + kChannelNames[target - 1];
    return error;
  }
  for (const int first : {1, 4}) {
    const auto of_triad = [&](bool increment) {
      return count(
          [&](const LogColumn& c) { return c.target >= first && c.target < first + 3 && c.increment == increment; });
    };
    if (of_triad(true) == 0 || of_triad(false) == 0) continue;
    error.what = first == 1 ? "rates and increments in one gyroscope" : "rates and increments in one accelerometer";
    error.expected = "one of the two";
    return error;
  }
  for (int target = 0; target <= 6; ++target)
    if (count([&](const LogColumn& c) { return c.target == target; }) > 1) {
      error.what = std::string("two columns for ") + (target == 0 ? "t" : kChannelNames[target - 1]);
      error.expected = "one";
      return error;
    }
  return Ok{};
}

bool says_nothing(const std::vector<LogColumn>& columns, const std::vector<std::string_view>& fields) {
  for (const LogColumn& column : columns) {
    if (column.field >= fields.size()) return false;
    std::string_view field = trimmed(fields[column.field]);
    if (!field.empty() && (field.front() == '-' || field.front() == '+')) field.remove_prefix(1);
    // Numbers begin with a digit or a point: nearly every field is done with here.
    if (!field.empty() && (field.front() <= '9')) continue;
    const std::string word = lower_case(field);
    if (word.empty() || word == "nan" || word == "inf" || word == "infinity" || word == "null") return true;
  }
  return false;
}

std::string layout_names() {
  std::string out;
  for (const ImuLogLayout& layout : kLayouts) out += (out.empty() ? "" : ", ") + std::string(layout.name);
  return out;
}

Result<std::vector<LogColumn>> asked_columns(const ImuLogFormat& format) {
  std::string names = format.columns;
  for (const ImuLogLayout& layout : kLayouts)
    if (names == layout.name) names = layout.make;
  const Error at{"--columns", 0, "", "", ""};
  CANYON_TRY(auto columns, log_columns(names, at));
  CANYON_TRY_STATUS(check_columns(columns, format.rate_hz, at));
  return columns;
}

ModelTable<const char*> imu_log_layouts() {
  return kLayouts;
}

}  // namespace canyon::inertial
