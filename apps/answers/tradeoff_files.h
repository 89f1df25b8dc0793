#pragma once

#include "canyon/core/output/staged.h"
#include "canyon/study/tradeoff/result.h"

namespace canyon::apps {

/// What was measured, as files of a directory that has been staged: summary.json, tradeoff.csv, fidelities.csv where
/// missions were measured as a whole, report.html. The directory has no name yet.
Status write_tradeoff_files(const study::Tradeoff& tradeoff, const StagedDirectory& staged);

}  // namespace canyon::apps
