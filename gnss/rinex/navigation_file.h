#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gnss/atmosphere/klobuchar.h"
#include "gnss/satellites/lnav_ephemeris.h"

namespace canyon::gnss {

/// What Canyon takes from a RINEX navigation file.
struct NavigationFile {
  std::string name;  ///< as given, for messages
  double version = 0.0;
  std::vector<LnavEphemeris> gps;  ///< in file order, unhealthy ones included
  std::optional<KlobucharCoefficients> klobuchar;
  std::optional<int> leap_seconds;
  int other_system_records = 0;       ///< of other systems, skipped
  std::vector<std::string> warnings;  ///< damaged records that were skipped, `file:line: what`
};

/// Reads a RINEX 2.x GPS or 3.x GPS or mixed navigation file, plain or gzip.
///
/// A damaged record (missing lines or fields, numbers that do not parse, an orbit that cannot be) is skipped with a
/// warning that names its line. Errors, each with file and line: not RINEX, wrong version or file type, no end of
/// header, no usable GPS record. Survives arbitrary bytes.
Result<NavigationFile> read_navigation_file(const std::string& path);
Result<NavigationFile> parse_navigation_file(std::string_view text, const std::string& file_name);

/// The span of the healthy records' fit intervals must hold [start, end], and at no time in it may fewer than four
/// satellites have a valid ephemeris; else an Error for `key` that names the span covered.
Status check_coverage(const NavigationFile& file, GpsTime start, GpsTime end, const std::string& key);

}  // namespace canyon::gnss
