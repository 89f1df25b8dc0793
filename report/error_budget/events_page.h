#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::report {

/// One self-contained HTML page of what `canyon lidar error-events` has left in a summary.json: how map and keyframes
/// change around each kind of event and around its placebos, with bands. No address outside itself.
Result<std::string> events_page(const std::string& summary_path);

}  // namespace canyon::report
