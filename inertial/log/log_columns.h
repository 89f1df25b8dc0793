#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/inertial/imu_log.h"

namespace canyon::inertial {

/// Where a column of an IMU's log goes: 0 time (s), 1..6 channels (rad/s, m/s^2, or their increments), and what its
/// numbers are multiplied by.
struct LogColumn {
  std::size_t field = 0;
  int target = 0;
  double factor = 1.0;
  bool increment = false;
};

/// Of names with commas between; those that mean nothing here are left out. Errors are `at`: a unit or a factor that is
/// none.
Result<std::vector<LogColumn>> log_columns(std::string_view names, const Error& at);
/// What --columns says, names or a layout, checked.
Result<std::vector<LogColumn>> asked_columns(const ImuLogFormat& format);
/// A time, or a rate in its place; all three channels of a triad, each once, all rates or all increments.
Status check_columns(const std::vector<LogColumn>& columns, double rate_hz, const Error& at);
/// "euroc, kf_gins".
std::string layout_names();
/// Whether a field that is wanted holds no number but a word for none.
bool says_nothing(const std::vector<LogColumn>& columns, const std::vector<std::string_view>& fields);

}  // namespace canyon::inertial
