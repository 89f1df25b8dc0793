#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject.
namespace canyon {

std::vector<StressCase> chi_square_cases();
std::vector<StressCase> configuration_cases();
std::vector<StressCase> date_cases();
std::vector<StressCase> draw_cases();
std::vector<StressCase> earth_cases();
std::vector<StressCase> geoid_cases();
std::vector<StressCase> motion_cases();
std::vector<StressCase> number_cases();
std::vector<StressCase> path_file_cases();
std::vector<StressCase> random_cases();
std::vector<StressCase> rotation_cases();
std::vector<StressCase> state_table_cases();
std::vector<StressCase> summary_cases();
std::vector<StressCase> time_cases();
std::vector<StressCase> true_motion_cases();

}  // namespace canyon
