#pragma once

#include <cstdint>

#include "canyon/core/model_table.h"

namespace canyon::lidar {

/// Which of a shot's detected echoes the sensor reports: `[lidar] returns`.
enum class ReturnMode : std::uint8_t { kStrongest, kFirst, kLast, kDual, kAll };

ModelTable<ReturnMode> return_modes();

/// A detected echo of a shot: its layer, and the energy received (full_overlap_m2()).
struct DetectedEcho {
  std::size_t layer = 0;
  float strength = 0.0f;
};

/// Keeps those of a shot's detected echoes that the mode reports and returns how many. Both lists are nearest first; of
/// equally strong ones the nearer counts. Dual: the last and the strongest; where these are one, the second strongest
/// with it.
std::size_t choose_returns(ReturnMode mode, DetectedEcho* echoes, std::size_t count);

}  // namespace canyon::lidar
