#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon::mission {

/// The stiff and extreme cases of mission/, and of what joins the sensors' floors.
std::vector<StressCase> stress_cases();

}  // namespace canyon::mission
