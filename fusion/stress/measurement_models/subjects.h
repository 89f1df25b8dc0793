#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject: rows of measurements over several messages.
namespace canyon::fusion {

std::vector<StressCase> lever_arm_cases();
std::vector<StressCase> measured_fix_cases();
std::vector<StressCase> range_cases();
std::vector<StressCase> single_reading_cases();
std::vector<StressCase> vehicle_motion_cases();

}  // namespace canyon::fusion
