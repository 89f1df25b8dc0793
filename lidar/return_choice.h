#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lidar/volley.h"

namespace canyon::lidar {

/// Which of a shot's detected echoes the sensor reports: `[lidar] returns`.
enum class ReturnMode : std::uint8_t { kStrongest, kFirst, kLast, kDual, kAll };

/// Rows of the configuration's list.
struct ReturnModeRow {
  const char* name;
  ReturnMode mode;
  const char* doc;
};
const std::vector<ReturnModeRow>& return_modes();

/// For two echoes or more.
std::size_t choose_of_several(ReturnMode mode, const Echo** echoes, std::size_t count);

/// Keeps the echoes of one shot that the mode reports, nearest first, and returns how many; `echoes` holds the detected
/// ones, nearest first. Strength is the energy received, reflectivity / range^2; of equals the nearer counts.
/// Dual: the last and the strongest; where these are one, the second strongest with it.
inline std::size_t choose_returns(ReturnMode mode, const Echo** echoes, std::size_t count) {
  return count <= 1 || mode == ReturnMode::kAll ? count : choose_of_several(mode, echoes, count);
}

}  // namespace canyon::lidar
