#pragma once

#include "canyon/study/compare.h"
#include "canyon/study/tradeoff/result.h"

namespace canyon::study {

/// How missions as a whole are measured.
struct WholeRuns {
  std::vector<Output> outputs = all_outputs();  ///< that somebody reads of the planned run
  int repetitions = 5;                          ///< of the timed part
  std::int64_t seeds = 3;                       ///< closed loops of each fidelity; 0: none
  std::uint64_t seed = 1;                       ///< of the order of repetitions
  bool show_progress = true;
};

/// The comparison with one run more, behind the first: the same again, which leaves out what its plan (study/plan) says
/// that the outputs do not need. Its name is the first one's with "_planned".
Result<Comparison> with_planned(const Comparison& comparison, const std::vector<Output>& outputs);

/// One per run of the comparison, and one for the first as planned: errors in an open loop over the whole tape; CPU
/// time of its first minute, repeated as probes are (measuring/repetitions.h); outcomes in closed loops, over seeds.
Result<std::vector<MeasuredFidelity>> measure_fidelities(const Comparison& comparison, const WholeRuns& how);

/// Drives each run of the comparison to its end, with `seeds` seeds from the mission's own on, and says how they end.
Result<std::vector<MeasuredOutcomes>> measure_outcomes(const Comparison& comparison, std::int64_t seeds,
                                                       bool show_progress);

}  // namespace canyon::study
