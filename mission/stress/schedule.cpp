#include "canyon/mission/motion/schedule.h"

#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

/// Everything that is due within a time: as often as its rate says, in order of time, equal times in the order of the
/// tasks, each at its own tick; and asked for in steps of 10 ms as a run does.
StressFigure due(const Schedule::Rates& rates_hz, double duration_s, GpsTime start) {
  Schedule schedule(start, rates_hz);
  std::array<std::int64_t, static_cast<std::size_t>(Task::kCount)> count{};
  int wrong = 0;
  Due before;
  before.t = start;
  const auto steps = static_cast<std::int64_t>(duration_s * 100.0);
  for (std::int64_t step = 1; step <= steps; ++step) {
    const GpsTime until{start.ns + step * 10'000'000};
    while (const auto next = schedule.next(until)) {
      const auto task = static_cast<std::size_t>(next->task);
      wrong += next->k == ++count[task] && next->t == tick(start, next->k, rates_hz[task]) ? 0 : 1;
      wrong += next->t > before.t || (next->t == before.t && (before.k == 0 || next->task > before.task)) ? 0 : 1;
      wrong += next->t <= until ? 0 : 1;
      before = *next;
    }
  }
  for (std::size_t i = 0; i < count.size(); ++i) {
    // A tick at the very end is rounded to a nanosecond, in or out.
    const double exact = duration_s * rates_hz[i];
    wrong += std::abs(static_cast<double>(count[i]) - std::floor(exact + 1e-6)) == 0.0 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> schedule_cases() {
  const StressMechanism mixed{
      StressGroup::kStiff, "rates from 0.01 to 10 000 Hz side by side",
      "periods that are added up part ways, a rate that is no multiple loses a tick, equal times come in any order",
      "each as often as its rate says, at its own ticks, in order: exact", "occurrences"};
  StressRows rows;
  rows.of(mixed).add("schedule/0.01_to_10000_hz", [] {
    return due({10000.0, 0.01, 10.0, 0.3, 1.0}, 100.0, GpsTime::from_week_sow(2160, 0.0));
  });
  rows.of(mixed).add("schedule/odd_rates_near_31_bits_of_seconds", [] {
    return due({333.0, 7.0, 9.99, 12.5, 97.0}, 200.0, {(std::int64_t{1} << 31) * kNsPerSecond});
  });
  rows.of(mixed).add("schedule/all_equal", [] { return due({50.0, 50.0, 50.0, 50.0, 50.0}, 60.0, GpsTime{7}); });
  rows.of(mixed)
      .add("schedule/a_day_at_odd_rates",
           [] {
             return due({97.0, 9.99, 0.3, 7.0, 0.01}, 86400.0, GpsTime::from_week_sow(2160, 0.0));
           })
      .long_running();
  return rows.take();
}

}  // namespace canyon::mission
