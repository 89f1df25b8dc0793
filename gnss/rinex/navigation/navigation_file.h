#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// Reads a RINEX navigation file, plain or gzip: version 2 (GPS and GLONASS files), 3 or 4, of one system or mixed.
///
/// Taken: ephemerides of GPS, GLONASS, Galileo, BeiDou and QZSS of every message of NavigationMessage; Klobuchar and
/// NeQuick coefficients, corrections between time systems, leap seconds. Other kinds of records (SBAS, NavIC, EOP, ...)
/// are skipped and counted. A damaged record (missing lines or fields, numbers that do not parse, an orbit that cannot
/// be) is skipped with a warning that names its line. Errors, each with file and line: not RINEX, wrong version or file
/// type, damaged or endless header, no usable ephemeris. Survives arbitrary bytes.
Result<NavigationData> read_navigation_file(const std::string& path);
/// Several files as one; the first Error of any of them.
Result<NavigationData> read_navigation_files(const std::vector<std::string>& paths);
Result<NavigationData> parse_navigation_file(std::string_view text, const std::string& file_name);

}  // namespace canyon::gnss
