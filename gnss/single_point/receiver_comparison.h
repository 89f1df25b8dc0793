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

/// What the receiver that made the observations said itself, NMEA 0183.
struct ReceiverLog {
  std::string file;
  std::vector<NmeaRecord> records;  ///< those with a fix, in order of time; at least one
  std::vector<std::string> warnings;
};

/// A log without a date is taken to begin on the UTC day of `first`, the first epoch observed. Errors: no GGA with a
/// fix in it.
Result<ReceiverLog> read_receiver_log(const std::string& nmea_path, GpsTime first);

/// How our fixes differ from what the receiver itself said of the same observations.
struct ReceiverComparison {
  std::string file;
  int records = 0;                ///< positions in its log
  PositionStatistics difference;  ///< ours minus its own, in east, north and up
  std::vector<std::string> warnings;
};

/// Errors: no position of the log is at a time of `fixes`, whichever of them were solved. There must be fixes.
Result<ReceiverComparison> compare_with_receiver(const std::vector<GnssFix>& fixes, const ReceiverLog& log);

}  // namespace canyon::gnss
