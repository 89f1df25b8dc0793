#pragma once

#include <cstdint>

#include "canyon/core/result.h"
#include "canyon/study/compare.h"

namespace canyon::study {

inline constexpr std::int64_t kLargestSeed = 9'000'000'000'000'000;  ///< of [run] seed

/// An Error if a comparison with that many seeds, the mission's own the first, asked for one that is too large.
Status check_seeds(const Comparison& comparison, std::int64_t seeds);

/// Every run of the comparison again with each of the `count` seeds that follow its own, into results.further_seeds.
/// Only the summaries are kept, so that memory does not grow with the rows of the runs. Runs go side by side as in
/// compare(); of an open loop all are on the same true motion. What they must put aside while they run goes to
/// `scratch` (ByteStore).
Status add_further_seeds(const Comparison& comparison, std::int64_t count, const std::string& scratch,
                         bool show_progress, Results& results);

}  // namespace canyon::study
