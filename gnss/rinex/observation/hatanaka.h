#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"

namespace canyon::gnss {

/// A RINEX observation file as it was before Hatanaka compression.
struct HatanakaText {
  std::string text;
  std::vector<int> source_line;       ///< of each line of `text`, the line of the compressed file that it comes from
  std::vector<std::string> warnings;  ///< damaged epochs and values that were left out, `file:line: what`
};

/// True if the text begins as a Compact RINEX file.
bool is_hatanaka(std::string_view text);

/// Undoes the compression of Hatanaka (2008), "A compression format and tools for GNSS observation data", Bulletin of
/// the Geospatial Information Authority of Japan 55; versions 1.0 (of RINEX 2) and 3.x (of RINEX 3 and 4).
///
/// Every number is sent as a difference in time of order up to 9 against its own arc, in whole thousandths; epoch lines
/// and flags as the characters that changed. A value whose difference cannot be read is left out, and so is the rest of
/// its arc, which depends on it; after an epoch line that cannot be read all is left out up to the next epoch line that
/// is sent whole. Errors: wrong version, no header. Survives arbitrary bytes.
Result<HatanakaText> undo_hatanaka(std::string_view text, const std::string& file_name);

}  // namespace canyon::gnss
