#pragma once

#include <string>

#include "canyon/study/fuse/run.h"

namespace canyon::study {

/// A run's filter with what it was given: of a results directory whose runs recorded that ([run]
/// record_filter_input = true; docs/results.md).
struct RecordedRun {
  std::string manifest;  ///< where the run's own filter is written
  FuseInputs inputs;     ///< the truth is that of epochs/RUN_nav.csv, of the vehicle's origin
  FusePlan plan;         ///< the run's own filter; estimates are kept at its epochs
};

/// Errors: no such run, which names those that are there; no record of the filter's input; files that are damaged.
Result<RecordedRun> read_recorded_run(const std::string& directory, const std::string& run);

/// Puts what `config` says in place of the run's own: [fusion], the unit of [imu] that the filter is told of, [score].
/// Errors: a filter that the run's record cannot feed, be it the run's own; keys that are of logs.
Status take_config(const FuseConfig& config, RecordedRun& run);

}  // namespace canyon::study
