#pragma once

#include <string>
#include <string_view>

#include "canyon/core/result.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// Reads a GPS almanac, YUMA or SEM, plain or gzip; the first line tells which. The records are of message kAlmanac,
/// good for a few kilometres, and used up to 14 days from their time of applicability (an almanac is good to about 1 km
/// in its first days and 4 km after two weeks, IS-GPS-200N table 20-VI). `near`: almanacs count weeks modulo 1024, and
/// the turn nearest to this instant is meant. QZSS satellites of a YUMA file (193 to 202) are J01 to J10.
/// A damaged record is skipped with a warning that names its line; errors with file and line: neither format, no usable
/// record.
Result<NavigationData> read_almanac_file(const std::string& path, GpsTime near);
Result<NavigationData> parse_almanac_file(std::string_view text, const std::string& file_name, GpsTime near);

}  // namespace canyon::gnss
