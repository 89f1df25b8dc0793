#pragma once

#include <string>

#include "canyon/report/read/results.h"

namespace canyon::report {

/// The chain of events and what each removal does, folded away under a line of plain text.
std::string why_details(const Why& why, const std::string& summary);

}  // namespace canyon::report
