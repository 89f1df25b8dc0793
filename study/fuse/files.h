#pragma once

#include <string>

#include "canyon/core/output/json.h"
#include "canyon/study/fuse/run.h"

/// What `canyon fuse` leaves on the disk (docs/fuse.md).
namespace canyon::study {

/// What summary.json holds, and --json prints.
Json fuse_json(const FuseInputs& inputs, const Fused& run);

/// nav.csv, estimate.nav, estimate.tum, estimate.kml, innovations.csv, errors.csv if there is a reference, and
/// summary.json, into an existing folder.
Status write_fused(const FuseInputs& inputs, const Fused& run, const std::string& folder);

}  // namespace canyon::study
