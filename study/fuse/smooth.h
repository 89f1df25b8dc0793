#pragma once

#include <string>
#include <vector>

#include "canyon/study/fuse/run.h"

namespace canyon::study {

/// One trajectory of a whole run, of what came before and after each instant.
struct FuseSmoothed {
  std::string smoother;  ///< row of fusion::smoothers()
  std::vector<FuseEpoch> epochs;
  std::vector<FuseError> errors;  ///< at the smoother's own instants, where the reference says something
  std::vector<OutageWindow> windows;
};

/// A smoother that there is, and that takes what the filter measures with.
Status check_smoother(const std::string& smoother, const fusion::FilterConfig& filter);

/// Smooths what a run's filter was given, divided and bridged as it was (`run` of a plan that keeps its segments), each
/// stretch between two starts by itself. Errors: as of check_smoother(); a gap of the IMU within a stretch, of a factor
/// graph; a build without one.
Result<FuseSmoothed> smooth(const std::string& smoother, const ModelParameters& own, const FuseInputs& inputs,
                            const FusePlan& plan, const Fused& run);

}  // namespace canyon::study
