#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::report {

/// Reads a results directory (docs/results.md), of runs or of a tradeoff (docs/tradeoff.md), and writes one
/// self-contained HTML page: no address outside itself, readable without scripts, below 5 MB. What the directory lacks
/// becomes a note on the page; what is malformed is an Error with file, line and key.
Status write_html_report(const std::string& results_dir, const std::string& out_file);

/// The page itself.
Result<std::string> html_report(const std::string& results_dir);

}  // namespace canyon::report
