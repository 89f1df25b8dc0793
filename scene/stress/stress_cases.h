#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon::scene {

/// Stiff and extreme cases of rays, tiles, surfaces, ground and crowns.
std::vector<StressCase> stress_cases();

}  // namespace canyon::scene
