#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/omissions.h"
#include "canyon/mission/part_clock.h"

namespace canyon::study {

/// One run on a tape in full and once more with something left out, on the same draws.
struct RunPair {
  std::int64_t epochs = 0;      ///< rows of estimates and of fixes compared
  std::int64_t violations = 0;  ///< of those, how many are not the same to the bit
  /// How far the two estimates of position are apart, row by row of estimates; a row that only one run has, infinitely.
  struct Apart {
    double t_s, position_m;
  };
  std::vector<Apart> apart;
  double simulated_s = 0.0;
  mission::PartClock full, planned;  ///< CPU time of each
};

/// Compares truth, estimate with its covariance, what the autonomy asks for, and fixes, row by row; over at most
/// `limit_s` of the tape.
Result<RunPair> drive_pair(mission::MissionConfig config, const mission::PreparedMission& mission, const Tape& tape,
                           const mission::Omissions& omissions,
                           double limit_s = std::numeric_limits<double>::infinity());

}  // namespace canyon::study
