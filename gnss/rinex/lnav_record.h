#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gnss/satellites/lnav_ephemeris.h"

namespace canyon::gnss {

/// Where the fields of a GPS navigation record stand: RINEX 2 and 3 differ in the first columns only.
struct LnavLayout {
  bool version3 = false;
  std::size_t clock_column() const { return version3 ? 23 : 22; }
  std::size_t orbit_column() const { return version3 ? 4 : 3; }
};

/// One GPS record: its first line and the seven that follow. The Error's line is the faulty one's, its `what` starts
/// with the satellite.
Result<LnavEphemeris> parse_lnav_record(const std::vector<std::string_view>& lines, int first_line,
                                        const std::string& file_name, const LnavLayout& layout);

}  // namespace canyon::gnss
