#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject: rows of integrators, and logs that go through them.
namespace canyon::fusion {

std::vector<StressCase> integrator_log_cases();
std::vector<StressCase> integrator_path_cases();
std::vector<StressCase> integrator_step_cases();
std::vector<StressCase> omission_cases();
std::vector<StressCase> rounding_growth_cases();

}  // namespace canyon::fusion
