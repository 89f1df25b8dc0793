#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "canyon/mission/scoring/scorer.h"
#include "canyon/study/results/results.h"

namespace canyon::study {

/// A run of a comparison that failed by itself, with one of its seeds.
struct FailedRun {
  std::size_t run = 0;  ///< of the comparison
  std::int64_t seed = 0;
  mission::Failure failure;
};

/// All of them, by seed and then in the order of the runs; with `most` (1 or more) of each run no more than so many,
/// those of the first seeds. What [time] limit_s stopped has not failed.
std::vector<FailedRun> failed_runs(const Results& results, std::optional<std::int64_t> most = std::nullopt);

}  // namespace canyon::study
