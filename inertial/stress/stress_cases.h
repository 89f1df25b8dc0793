#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon::inertial {

/// The stiff and extreme cases of inertial/.
std::vector<StressCase> stress_cases();

}  // namespace canyon::inertial
