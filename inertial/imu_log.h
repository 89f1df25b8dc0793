#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/model_table.h"
#include "canyon/core/result.h"
#include "canyon/core/tables/passed_over.h"

namespace canyon::inertial {

/// A recorded IMU: time and six rates, SI. A channel that the file lacks is empty.
struct ImuLog {
  std::vector<double> t_s;
  std::array<std::vector<double>, 6> channels;  ///< gx gy gz in rad/s, ax ay az in m/s^2
  /// Whether the file holds increments of the gyroscope, of the accelerometer. They became rates by the usual interval
  /// (sampling_of), which every increment covers, whatever stamps and gaps say; times that interval they come back.
  std::array<bool, 2> increments{};
  /// What makes the units that the file names look mistaken, a line each; they were taken as named.
  std::vector<std::string> doubts;

  std::vector<int> lines;  ///< of the file, on which the samples stand
  PassedOver passed_over;  ///< where the format lets rows be

  std::size_t size() const { return t_s.size(); }
};
inline constexpr const char* kChannelNames[6] = {"gx", "gy", "gz", "ax", "ay", "az"};

struct ImuLogFormat {
  /// Column names for a file without header, or instead of its own, separated by commas; or the name of a row of
  /// imu_log_layouts(). A name is a channel and a unit as core/tables/column_names.h spells them (`gx_rad_s` or
  /// `gx_rps`, `gy_deg_s` or `gy_dps`, `gz_deg_h`, `az_m_s2` or `az_mps2`, `ax_g`, `ax_mg`; `t_s`, `t_ms`, `t_us`,
  /// `t_ns`, `sow`; `wx`, `gyro_x`, `acc_x` are channels too), with a factor if the file has counts or the axis points
  /// the other way: `gx_deg_s*0.05`, `gy_rad_s*-1`. Increments over a sample interval (`gx_rad`, `gx_deg`, `ax_m_s`)
  /// become rates; a triad's channels are all rates or all increments. Other names are passed over.
  std::string columns{};
  /// Sample rate of a file without a time column, or to be taken instead of its times; 0 = the file's times.
  double rate_hz = 0.0;
  /// Refuses channels that never change or stay at their extreme value, as those of a working sensor never do.
  bool live = true;
  /// Passes over rows with a field that is empty or says NaN, and rows that are not later than the one before, where
  /// they are else an Error; ImuLog::passed_over counts them.
  bool mend = false;
};

/// A layout that is in use elsewhere, by name.
using ImuLogLayout = ModelRow<const char*>;  ///< makes the names of the columns
ModelTable<const char*> imu_log_layouts();

/// Reads CSV, or columns apart by blanks, plain or gzip. Errors name the line: missing columns, fields that are not
/// numbers or beyond 1e12 rad/s or m/s^2, time that does not increase, channels stuck at one value or saturated, and
/// magnitudes that betray the unit. Where the header or `columns` name the unit, a rate that no gyroscope measures is
/// only a doubt, and of a log that turns fast so is the force. Else an accelerometer shows gravity on average, so a
/// specific force of some 1 or 980 means g or cm/s^2 where m/s^2 is said, and one of gravity times the interval means
/// increments, and the other way round; a gyroscope that the accelerometer does not bear witness for (none there, or
/// the one said to be increments and the other not) betrays itself where its mean is the Earth's rate times the
/// interval or divided by it.
Result<ImuLog> read_imu_log(const std::string& path, const ImuLogFormat& format);

}  // namespace canyon::inertial
