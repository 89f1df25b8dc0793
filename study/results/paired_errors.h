#pragma once

#include <string>

#include "canyon/study/results/run_statistics.h"

namespace canyon::study {

/// How much larger run b's position error is than run a's on the same true motion, epoch by epoch.
struct PairedErrors {
  std::string a, b;
  int epochs = 0;  ///< of equal time in both
  double mean_m = kNaN;
  double low_m = kNaN, high_m = kNaN;  ///< 95 % interval of the mean (BatchMeans); NaN with fewer than two batches
  double worse_share = kNaN;           ///< of the epochs at which b's error is the larger one
};

/// The errors of each in the order of time, of runs that began at `start`; `a`, `b` of the answer are yet to be named.
Result<PairedErrors> paired_errors(const RowStore<EpochError>& a, const RowStore<EpochError>& b, GpsTime start);

}  // namespace canyon::study
