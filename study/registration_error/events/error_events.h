#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/output/json.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/registration_error/events/event_average.h"
#include "canyon/study/registration_error/events/event_regression.h"

namespace canyon::study {

struct ErrorEventsOptions {
  std::string fidelity = "high";
  std::int64_t seeds = 20;  ///< the mission's own the first
  std::int64_t starts = 4;  ///< times of day, the mission's own the first, the others evenly over the day that follows
  bool show_progress = true;
};

/// What one kind of event does to one series of errors (kErrorSeries).
struct EventEffect {
  EventAverage average;
  EventRegression regression;  ///< told apart from the other kinds; without lags where the kind was never seen
};

struct ErrorEvents {
  std::string mission, fidelity, tape;
  bool registered = false;  ///< false: the two registered series are empty
  std::int64_t seed = 0, seeds = 0, starts = 0;
  /// By row of map_event_kinds(), then by series.
  std::vector<std::array<EventEffect, kErrorSeries.size()>> effects;
  double cpu_s = 0.0;
};

/// What happens to map and keyframes around events of the sky and of the estimate, on one true motion. Every seed is
/// driven at several times of the day: the satellites are others, everything else is the same, so that each event has
/// placebos at its own place (event_average.h). Errors as of a mission whose sky cannot be made at one of the starts.
/// Same bits for any number of threads.
Result<ErrorEvents> find_error_events(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                      const Tape& tape, const ErrorEventsOptions& options);

/// The same of runs that have been made.
std::vector<std::array<EventEffect, kErrorSeries.size()>> effects_of(const std::vector<SeedSeries>& seeds,
                                                                     std::uint64_t bootstrap_seed);

Json error_events_json(const ErrorEvents& events);
/// `kind,series,lag_s,event,event_low,event_high,placebo,…,contrast,…,null,…`, a line per lag, m.
std::string error_events_csv(const ErrorEvents& events);
std::string error_events_table(const ErrorEvents& events);

}  // namespace canyon::study
