#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

/// Cases of what studies are judged by, a file for each subject.
namespace canyon::study {

std::vector<StressCase> share_cases();
std::vector<StressCase> cause_cases();

/// All of them; the rest of this floor drives others, whose cases are theirs.
std::vector<StressCase> study_stress_cases();

}  // namespace canyon::study
