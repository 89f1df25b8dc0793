#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/fusion/verdict/verdict.h"

namespace canyon::study {

/// The numbers behind a verdict as `evidence` of summary.json and of canyon fuse (docs/results.md). Undefined is null.
nlohmann::ordered_json evidence_json(const fusion::VerdictNumbers& numbers);

/// The verdict on one line: the first faults, and how many more there are; "consistent" without any.
std::string verdict_in_short(const std::vector<std::string>& verdict);

}  // namespace canyon::study
