#pragma once

#include <optional>
#include <vector>

#include "canyon/study/statistics/block_bootstrap.h"
#include "canyon/study/tradeoff/probes/probe.h"

namespace canyon::study {

/// How two rungs' values differ, sample by sample.
struct Differences {
  std::vector<SquareSum> samples;  ///< squares of the vectors' lengths, and how many vectors both have
  double undefined_share = 0.0;  ///< of the vectors that either has, that only one has, or that are of different things
};

/// `b` null: against zero, which is the truth where a probe knows it.
Differences differences(const Samples& a, const Samples* b);

/// Of each against the truth, over the vectors that all of them have; those without any count as absent, and are NaN.
std::vector<double> common_rms(const std::vector<const Samples*>& all);

/// Root mean square over all of them; NaN without any.
double rms(const Differences& d);

}  // namespace canyon::study
