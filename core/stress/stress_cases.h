#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon {

/// The stiff and extreme cases of core/.
std::vector<StressCase> stress_cases();

}  // namespace canyon
