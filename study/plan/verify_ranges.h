#pragma once

#include "canyon/study/plan/verify.h"

namespace canyon::study {

/// Adds what was found of the omissions with a bound above 0, at `epochs` epochs each:
/// - of each by itself and of all together: how far ranges move as the receiver sees them (corrected, less the distance
///   of the satellite that it computed) from the true antenna, against the bound in that unit; and how far the fix
///   moves, against the bound times that epoch's sum of |d position / d range|;
/// - of what the filter's integrator leaves out: how far apart the attitudes of free integrations with and without it
///   are at most along whole runs, against the bound;
/// - of all together, in whole runs of seeds after those that the bounds were taken from: how far the estimate of
/// position moves,
///   row by row, against the plan's bound for that time.
Status verify_ranges(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
                     const Plan& plan, std::int64_t epochs, Verification& verification);

}  // namespace canyon::study
