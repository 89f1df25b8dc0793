#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// The cases of this room, a file for each subject: where a registration looks, and what it says by blocks.
namespace canyon::lidar {

std::vector<StressCase> old_shell_cases();
std::vector<StressCase> search_start_cases();
std::vector<StressCase> tree_border_cases();

}  // namespace canyon::lidar
