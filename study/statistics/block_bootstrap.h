#pragma once

#include <cstdint>
#include <span>

#include "canyon/study/statistics/interval.h"

namespace canyon::study {

/// Sum of squares of a sample's values, and how many there were.
struct SquareSum {
  double sum = 0.0, count = 0.0;
};

/// Root mean square over samples, with how sure it is.
struct RmsEstimate {
  double rms = kNaN;
  double sigma = kNaN;  ///< of the replicates; NaN for fewer than eight samples
  Interval interval;    ///< 95 %, by percentiles
};

/// By the block bootstrap: whole blocks of n^(1/3) consecutive samples (rounded up, the last followed by the first) are
/// drawn anew, so that samples that are alike because they are near stay together (Kuensch, Ann. Stat. 17 (1989) 1217,
/// the circular form of Politis & Romano 1992; the length's order is that of Hall, Horowitz & Jing 1995). 1000
/// replicates of the stream "tradeoff.bootstrap". Samples without values count for nothing; without any, undefined.
RmsEstimate block_bootstrap_rms(std::span<const SquareSum> samples, std::uint64_t seed);

}  // namespace canyon::study
