#pragma once

#include <optional>
#include <string>

#include "canyon/study/results/figures.h"

namespace canyon::study {

/// The inverse question: the cheapest combination whose figure changes by no more than a tolerance, or the most
/// faithful one within a budget.
struct Question {
  const Figure* figure = nullptr;
  double tolerance = kNaN;     ///< largest change of the figure, in its unit
  double budget_cpu_s = kNaN;  ///< CPU seconds per simulated second
};

/// Of the options --tolerance FIGURE=VALUE (empty: not given), --budget-cpu and --figure. None where nothing is asked.
/// Errors: an unknown figure, one that depends on the machine, a tolerance or budget that is not above zero, both at
/// once.
Result<std::optional<Question>> read_question(const std::string& tolerance, std::optional<double> budget_cpu_s,
                                              const std::string& figure);

}  // namespace canyon::study
