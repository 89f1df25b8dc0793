#pragma once

#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon::fusion {

/// The stiff and extreme cases of fusion/.
std::vector<StressCase> stress_cases();

}  // namespace canyon::fusion
