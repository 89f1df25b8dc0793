#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::report {

/// One self-contained HTML page of what `canyon lidar error-response` has left in a summary.json: how much of each
/// error registration heals, by its size, method and place. No address outside itself.
Result<std::string> response_page(const std::string& summary_path);

}  // namespace canyon::report
