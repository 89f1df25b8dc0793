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

/// How well each state is known over time, a panel for each block; empty without any. `run` gives the colour.
std::string observability_chart(const FilterVerdict& verdict, std::size_t run);

}  // namespace canyon::report
