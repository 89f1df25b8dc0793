#pragma once

#include <cstdint>
#include <vector>

#include "canyon/study/registration_error/events/keyframe_series.h"
#include "canyon/study/statistics/interval.h"

namespace canyon::study {

/// The runs of one seed on one tape: index 0 at the mission's own start, the others at other starts. Places, speeds,
/// noise of IMU and LIDAR are the same, the satellites are others.
using SeedSeries = std::vector<ErrorSeries>;

/// The stretch of time around an event that is looked at.
inline constexpr double kBefore_s = 5.0, kAfter_s = 20.0, kLagStep_s = 0.5;
/// What an event does is the mean over so long after it.
inline constexpr double kEffect_s = 10.0;
/// -kBefore_s, ..., kAfter_s.
std::vector<double> event_lags_s();

/// A mean by lag, with a band over seeds.
struct LagCurve {
  std::vector<double> mean;
  std::vector<Interval> band;
};

struct EstimatedNumber {
  double value = kNaN;
  Interval interval;
};

/// What one kind of event goes with in one series of errors: changes from the mean of the kBefore_s before it, m.
struct EventAverage {
  int events = 0;           ///< seen, in all runs
  int matched = 0;          ///< that have keyframes about them, and a placebo
  double mean_size = kNaN;  ///< of the matched
  LagCurve event;           ///< around the events
  LagCurve placebo;         ///< around the same places without: what the place alone does
  LagCurve contrast;        ///< event less its placebos
  LagCurve null;            ///< a placebo less the event's others: 0, if placebos are what they should be
  /// Means over (0, kEffect_s].
  EstimatedNumber event_m, placebo_m, effect_m, null_m;
  /// Of the contrast's mean curve, in the direction of the effect: since the event until half of its peak, and from
  /// there until it is below half of it again (or kAfter_s is over).
  EstimatedNumber delay_s, duration_s;
};

/// Averages over all events of the kind in all runs. An event's placebos are the seed's runs at other starts in which
/// nothing of that kind lasts within its window: there the vehicle drives the same way past the same walls. Bands:
/// seeds drawn anew (cluster_bootstrap.h).
EventAverage average_events(const std::vector<SeedSeries>& seeds, MapEventKind kind, std::size_t series,
                            std::uint64_t bootstrap_seed);

}  // namespace canyon::study
