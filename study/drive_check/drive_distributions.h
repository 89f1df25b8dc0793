#pragma once

#include <vector>

#include "canyon/core/output/json.h"
#include "canyon/study/drive_check/drive_figures.h"

namespace canyon::study {

/// Everything of one kind that a drive gave, in order of size; infinite: an instant without a fix.
struct DriveDistribution {
  const char* key;  ///< with its unit
  std::vector<double> values;
};

/// C/N0, range errors and range-rate errors of signals in sight and hidden, horizontal errors of fixes: always the same
/// seven, in this order.
std::vector<DriveDistribution> drive_distributions(const std::vector<DriveEpoch>& epochs,
                                                   const std::vector<DriveFix>& fixes);

/// By key: how many values each side has, and their percentiles 0 to 100, linear between ranks; null where infinite,
/// and no percentiles of none.
Json drive_distributions_json(const std::vector<DriveDistribution>& simulated,
                              const std::vector<DriveDistribution>& measured);

}  // namespace canyon::study
