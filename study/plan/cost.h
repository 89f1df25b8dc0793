#pragma once

#include "canyon/core/files/tape.h"
#include "canyon/study/plan/plan.h"

namespace canyon::study {

/// CPU time of the nominal mission, in full and as planned.
struct PredictedCost {
  double full_s = kNaN, planned_s = kNaN;
};

/// Measures on this machine what a plan saves, and writes it into its effects: the run's first kSample_s on the tape,
/// twice, part by part; and kEpochs epochs of the GNSS sensor spread over it, with and without each effect. Scaled to
/// the mission's nominal time. A difference below the clock's own scatter counts as nothing.
Result<PredictedCost> measure_cost(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                   const Tape& tape, Plan& plan);

}  // namespace canyon::study
