#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::report {

/// One self-contained HTML page of a reproduction's summary.json: each table and figure of the paper, its numbers
/// beside ours, ours drawn, and what differs. No address outside itself, readable without scripts. Errors name file,
/// line and key of what cannot be read.
Result<std::string> reproduce_page(const std::string& summary_path);

}  // namespace canyon::report
