#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject.
namespace canyon::mission {

std::vector<StressCase> autonomy_cases();
std::vector<StressCase> boundary_cases();
std::vector<StressCase> collision_cases();
std::vector<StressCase> command_cases();
std::vector<StressCase> drive_cases();
std::vector<StressCase> ground_cell_cases();
std::vector<StressCase> localizer_cases();
std::vector<StressCase> mapping_cases();
std::vector<StressCase> path_cases();
std::vector<StressCase> perception_cases();
std::vector<StressCase> plan_cases();
std::vector<StressCase> plan_model_cases();
std::vector<StressCase> schedule_cases();
std::vector<StressCase> searched_plan_cases();
std::vector<StressCase> self_check_cases();
std::vector<StressCase> sprung_mass_cases();
std::vector<StressCase> tape_cases();
std::vector<StressCase> traffic_cases();
std::vector<StressCase> vehicle_cases();
std::vector<StressCase> score_cases();

}  // namespace canyon::mission
