#pragma once

#include <string>

#include "canyon/core/output/json.h"
#include "canyon/study/dead_reckoning/dead_reckoning.h"

/// What a dead reckoning leaves on the disk (docs/inertial.md).
namespace canyon::study {

/// What summary.json holds, and --json prints.
Json dead_reckoning_json(const DeadReckoning& result);

/// estimate.nav, heading.csv, drift.csv if there is a reference, and summary.json, into an existing folder.
Status write_dead_reckoning(const DeadReckoning& result, const PlainIntegrals& plain, const std::string& folder);

}  // namespace canyon::study
