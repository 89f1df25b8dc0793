#include "canyon/mission/motion/schedule.h"

#include "canyon/core/check.h"

namespace canyon::mission {

Schedule::Schedule(GpsTime start, const Rates& rates_hz) : start_(start), rates_hz_(rates_hz) {
  for (const double rate_hz : rates_hz) CANYON_CHECK(rate_hz >= 0.0, "rate_hz = ", rate_hz);
}

std::optional<Due> Schedule::next(GpsTime until) {
  std::optional<Due> first;
  for (std::size_t i = 0; i < rates_hz_.size(); ++i) {
    if (rates_hz_[i] == 0.0) continue;
    const GpsTime t = tick(start_, k_[i] + 1, rates_hz_[i]);
    if (t <= until && (!first || t < first->t)) first = Due{t, static_cast<Task>(i), k_[i] + 1};
  }
  if (first) ++k_[static_cast<std::size_t>(first->task)];
  return first;
}

}  // namespace canyon::mission
