#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::report {

/// One self-contained HTML page of what `canyon lidar error-budget` has left in a summary.json: which source caused how
/// much of the map's, its heights' and the keyframes' mean square error. No address outside itself.
Result<std::string> budget_page(const std::string& summary_path);

}  // namespace canyon::report
