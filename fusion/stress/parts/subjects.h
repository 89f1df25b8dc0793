#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject: parts of a filter, each by itself.
namespace canyon::fusion {

std::vector<StressCase> arrival_cases();
std::vector<StressCase> body_estimate_cases();
std::vector<StressCase> error_step_cases();
std::vector<StressCase> given_setting_cases();
std::vector<StressCase> known_start_cases();
std::vector<StressCase> lasting_error_cases();
std::vector<StressCase> process_cases();
std::vector<StressCase> renewed_state_cases();
std::vector<StressCase> run_graph_cases();
std::vector<StressCase> run_message_cases();
std::vector<StressCase> satellite_place_cases();
std::vector<StressCase> start_cases();
std::vector<StressCase> state_block_cases();
std::vector<StressCase> trust_cases();

}  // namespace canyon::fusion
