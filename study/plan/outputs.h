#pragma once

#include <string>
#include <vector>

#include "canyon/core/result.h"

namespace canyon::study {

/// What somebody reads of a run.
enum class Output {
  kOutcome,   ///< how the mission ended, waypoints, distance
  kPosition,  ///< estimate, fixes and their errors
  kMap,       ///< figures of registration and of the scored maps, keyframes
  kClouds     ///< the scored maps as clouds/*.pcd, each point with its error
};
const char* name(Output output);

/// Outputs by their names, each once; an Error, for `option`, names the nearest.
Result<std::vector<Output>> outputs_of(const std::vector<std::string>& names, const std::string& option);
std::vector<Output> all_outputs();
bool reads(const std::vector<Output>& outputs, Output one);

}  // namespace canyon::study
