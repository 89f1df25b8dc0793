#pragma once

#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/gnss/rinex/text_lines.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// The header of a RINEX navigation file, up to and with END OF HEADER.
struct NavigationHeader {
  double version = 0.0;
  char system = 'G';  ///< of all records of a RINEX 2 file, G or R; of RINEX 3 and 4 as written, M = mixed
  std::vector<BroadcastKlobuchar> klobuchar;  ///< without their times, which the header does not tell
  std::optional<int> leap_seconds;
  std::vector<std::string> warnings;  ///< ionosphere coefficients that cannot be read, `file:line: what`

  bool version2() const { return version < 3.0; }
};

Result<NavigationHeader> parse_navigation_header(TextLines& lines, const std::string& file_name);

}  // namespace canyon::gnss
