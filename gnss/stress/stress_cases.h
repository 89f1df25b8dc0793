#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon::gnss {

/// Stiff and extreme cases of satellites, atmosphere, paths, receiver, solver, files and the sensor as a whole.
std::vector<StressCase> stress_cases();

}  // namespace canyon::gnss
