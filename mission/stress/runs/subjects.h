#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject: whole runs, and what only a run has.
namespace canyon::mission {

std::vector<StressCase> heard_run_cases();
std::vector<StressCase> ended_run_cases();
std::vector<StressCase> corridor_cases();
std::vector<StressCase> default_cases();
std::vector<StressCase> search_cases();

}  // namespace canyon::mission
