#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"

namespace canyon::gnss {

struct ClockSample {
  GpsTime t;
  double clock_s = 0.0;  ///< minus the time scale of the file, without the periodic relativity
};

/// Satellite clocks of a RINEX clock file (AS records); those of receivers are not kept.
struct ClockFile {
  std::string name;
  double interval_s = 0.0;                                     ///< the most frequent between samples of a satellite
  std::map<SatelliteId, std::vector<ClockSample>> satellites;  ///< ascending
  std::vector<std::string> warnings;

  /// Linear between the two samples around t; NaN where they are further apart than 1.5 intervals, or t is outside.
  double clock_s(SatelliteId sv, GpsTime t) const;
};

/// Reads a RINEX clock file of version 2, 3.00 to 3.04, in GPS or UTC time, plain or gzip. Errors with file and line:
/// not RINEX clock data, no end of header, no satellite clock. Damaged lines are skipped with a warning.
Result<ClockFile> read_clock_file(const std::string& path);
Result<ClockFile> parse_clock_file(std::string_view text, const std::string& file_name);

}  // namespace canyon::gnss
