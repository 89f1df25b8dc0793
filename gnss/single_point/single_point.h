#pragma once

#include <map>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/single_point/base_station.h"
#include "canyon/gnss/single_point/config.h"
#include "canyon/gnss/solver/position_solver.h"

namespace canyon::gnss {

/// One epoch solved.
struct SinglePointEpoch {
  GnssFix fix;      ///< of the antenna; velocity where there is Doppler of four satellites
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

/// What the observations are solved with.
struct SinglePointInputs {
  const Constellation& constellation;
  const NavigationData& navigation;            ///< for its ionosphere coefficients and its names in messages
  const IonexMaps* ionosphere_maps = nullptr;  ///< needed where config.ionosphere is "ionex"
  /// Positions are differential then: ranges are corrected by what the base's, smoothed as configured, are off, beside
  /// what the models differ by between the two places; satellites that the base does not have are not used.
  const BaseRecording* base = nullptr;
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
