#pragma once

#include <string>
#include <vector>

#include "canyon/gnss/nmea/nmea_reader.h"
#include "canyon/gnss/single_point/position_statistics.h"

namespace canyon::gnss {

/// Epochs of two solutions are the same where their times are at most this far apart, s: what a receiver states is by
/// its own clock, which cheap ones let run off by milliseconds, rounded to 10 ms in NMEA; 10 fixes a second are told
/// apart.
inline constexpr double kSameEpoch_s = 0.045;

/// How our fixes differ from what the receiver itself said of the same observations.
struct ReceiverComparison {
  std::string file;
  int records = 0;                ///< positions in its log
  PositionStatistics difference;  ///< ours minus its own, in east, north and up
  std::vector<std::string> warnings;
};

/// The log is NMEA 0183 of the receiver that made the observations; without a date it is taken to begin on the UTC day
/// of the first fix. Errors: no position in it, or none at a time of `fixes`, whichever of them were solved.
Result<ReceiverComparison> compare_with_receiver(const std::vector<GnssFix>& fixes, const std::string& nmea_path);

}  // namespace canyon::gnss
