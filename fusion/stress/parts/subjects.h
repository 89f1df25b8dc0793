#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject: parts of a filter, each by itself.
namespace canyon::fusion {

std::vector<StressCase> arrival_cases();
std::vector<StressCase> body_estimate_cases();
std::vector<StressCase> run_graph_cases();
std::vector<StressCase> run_message_cases();
std::vector<StressCase> start_cases();
std::vector<StressCase> state_cases();
std::vector<StressCase> trust_cases();

}  // namespace canyon::fusion
