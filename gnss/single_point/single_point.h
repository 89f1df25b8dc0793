#pragma once

#include <map>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/single_point/config.h"
#include "canyon/gnss/single_point/observed_ranges.h"
#include "canyon/gnss/solver/position_solver.h"

namespace canyon::gnss {

/// One epoch solved.
struct SinglePointEpoch {
  GnssFix fix;      ///< of the antenna; velocity and its covariance where there is Doppler of four satellites
  GnssEpoch epoch;  ///< the observations that could be used: satellite, corrections, sigma; `used` = in the fix
  std::vector<double> residuals_m;  ///< of the epoch's observations; empty without a fix
  IntegrityTest integrity;
  int excluded = 0;  ///< by the fault exclusion
};

struct SinglePointResult {
  std::vector<SinglePointEpoch> epochs;  ///< one for each of the file, in its order
  std::map<std::string, int> reasons;    ///< why epochs have no fix, with figures left out, and how often
  std::vector<std::string> warnings;     ///< satellites that were observed but could not be used, `file:line: what`
  int solved() const;
};

/// Positions of a recorded observation file, epoch by epoch.
///
/// Satellites are placed by their pseudorange; those without a valid healthy ephemeris are not used, and told in the
/// warnings. Errors: no system of config.systems observed; no satellite of any epoch with an ephemeris (navigation data
/// of another day); a Klobuchar correction without coefficients, or maps that do not cover the observations; a base
/// without an epoch near those of the observations, or without a satellite in common.
Result<SinglePointResult> solve_observations(const ObservationFile& observations, const SinglePointInputs& inputs,
                                             const SinglePointConfig& config);

}  // namespace canyon::gnss
