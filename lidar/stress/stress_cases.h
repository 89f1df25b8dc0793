#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon::lidar {

/// Stiff and extreme cases of beam, air, receiver, packets, motion within a sweep and registration.
std::vector<StressCase> stress_cases();

}  // namespace canyon::lidar
