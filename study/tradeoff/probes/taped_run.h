#pragma once

#include "canyon/core/files/tape.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/omissions.h"
#include "canyon/study/results/summary.h"

namespace canyon::study {

/// A whole run in an open loop on the first limit_s of a tape, one thread; only its figures are kept. `omissions`: what
/// it leaves out, if anything.
Result<RunSummary> taped_run(mission::MissionConfig config, const mission::PreparedMission& mission, const Tape& tape,
                             double limit_s, const mission::Omissions* omissions = nullptr);

/// All its counters together: the work of a run.
std::int64_t work_of(const RunSummary& run);

}  // namespace canyon::study
