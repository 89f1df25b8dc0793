#pragma once

#include <map>
#include <string>
#include <vector>

#include "canyon/core/result.h"

namespace canyon::study {

/// By a figure's key (study/results/figures.h): how far it may move over the run, in the figure's own unit.
using Tolerances = std::map<std::string, double>;

/// From "FIGURE=VALUE" each; an Error, for `option`, for an unknown figure and a value that is not above 0.
Result<Tolerances> tolerances_of(const std::vector<std::string>& texts, const std::string& option);

}  // namespace canyon::study
