#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::report {

/// One self-contained HTML page of what `canyon gnss drive-check --out` has left in a directory: the figures of the
/// simulated and the recorded drive, their distributions beside one another, each satellite over time. No address
/// outside itself, readable without scripts.
Result<std::string> drive_page(const std::string& directory);

}  // namespace canyon::report
