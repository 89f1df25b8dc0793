#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "canyon/study/registration_error/events/event_average.h"

namespace canyon::study {

/// Times since an event, s, by whose ranges its effect may differ: before it, then (edge, next edge].
inline constexpr std::array<double, 9> kLagEdges_s{-kBefore_s, 0.0, 1.0, 2.0, 4.0, 7.0, 10.0, 15.0, 20.0};

/// What one kind of event alone does, the others held fast.
struct EventRegression {
  MapEventKind kind = MapEventKind::kDilutionJump;
  std::vector<EstimatedNumber> by_lag;  ///< after the event, by the ranges of kLagEdges_s, less the one before it
  EstimatedNumber effect_m;             ///< mean over (0, kEffect_s], as EventAverage::effect_m
};

/// Least squares of one series of errors over all runs and all kinds at once: what a place does in a seed, plus for
/// every event of kind k the coefficient of (k, range of the time since it). Events that overlap each get their own.
/// Places are seconds of the tape, whose effects are taken out by what the seed's other starts have there. Bands: seeds
/// drawn anew. Kinds that no run has are left out; where kinds always come together, as the loss and the return of a
/// fix that is short, the solution of least norm shares what they do.
std::vector<EventRegression> regress_events(const std::vector<SeedSeries>& seeds, std::size_t series,
                                            std::uint64_t bootstrap_seed);

}  // namespace canyon::study
