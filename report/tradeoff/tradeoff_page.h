#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::report {

/// One self-contained HTML page of a tradeoff's summary.json: a work-precision diagram and a table per ladder, whole
/// runs by fidelity, the answer to the question that was asked. No address outside itself, readable without scripts.
Result<std::string> tradeoff_page(const std::string& summary_path);

}  // namespace canyon::report
