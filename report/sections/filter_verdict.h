#pragma once

#include <string>

#include "canyon/report/read/filter_verdict.h"

namespace canyon::report {

/// The words, and beneath them the numbers they are from.
std::string filter_words(const FilterVerdict& verdict);
/// Empty without numbers.
std::string consistency_table(const FilterVerdict& verdict);
/// Which states the measurements tell, and from when on; empty without any.
std::string observability_table(const FilterVerdict& verdict);

}  // namespace canyon::report
