#pragma once

#include <string>

#include "canyon/core/output/json.h"
#include "canyon/study/fuse/run.h"
#include "canyon/study/fuse/smooth.h"

/// What `canyon fuse` leaves on the disk (docs/fuse.md).
namespace canyon::study {

/// What summary.json holds, and --json prints. `smoothed` may be null, here and below.
Json fuse_json(const FuseInputs& inputs, const Fused& run, const FuseSmoothed* smoothed);

/// nav.csv, estimate.nav, estimate.tum, estimate.kml, innovations.csv, errors.csv if there is a reference,
/// smoothed.nav, smoothed.csv and smoothed_errors.csv likewise, and summary.json, into an existing folder.
Status write_fused(const FuseInputs& inputs, const Fused& run, const FuseSmoothed* smoothed, const std::string& folder);

}  // namespace canyon::study
