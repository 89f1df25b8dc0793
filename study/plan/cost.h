#pragma once

#include "canyon/core/files/tape.h"
#include "canyon/study/plan/plan.h"

namespace canyon::study {

/// CPU time of the nominal mission, in full and as planned.
struct PredictedCost {
  double full_s = kNaN, planned_s = kNaN;
};

/// Measures on this machine what a plan saves, and writes it into its effects: the run's first kSample_s on the tape,
/// with and without, part by part; and kEpochs epochs of the GNSS sensor drawn from it, with and without each effect.
/// All twice: a difference that is not larger than the two measurements differ counts as nothing. Scaled to the
/// mission's nominal time. Nothing of a plan depends on it.
Result<PredictedCost> measure_cost(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                   const Tape& tape, Plan& plan);

}  // namespace canyon::study
