#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "canyon/core/time.h"

namespace canyon::mission {

/// What happens in a run at times of its own. The order is that of equal times.
enum class Task { kImu, kOdometer, kBarometer, kMagnetometer, kGnss, kLidar, kAutonomy, kEpoch, kCount };

/// One thing that is due: occurrence `k` (from 1 on) of a task.
struct Due {
  GpsTime t;
  Task task = Task::kCount;
  std::int64_t k = 0;
};

/// Every task at its own ticks: occurrence k at round(k 10^9 / rate) ns from the start, never accumulated. No rate
/// needs to be a multiple of another.
class Schedule {
 public:
  using Rates = std::array<double, static_cast<std::size_t>(Task::kCount)>;

  /// Rates in Hz in the order of Task; 0: never.
  Schedule(GpsTime start, const Rates& rates_hz);

  /// Takes the next occurrence at or before `until`, in order of time, equal times in the order of Task.
  std::optional<Due> next(GpsTime until);

 private:
  GpsTime start_;
  Rates rates_hz_;
  std::array<std::int64_t, static_cast<std::size_t>(Task::kCount)> k_{};
};

}  // namespace canyon::mission
