#pragma once

#include <string>
#include <string_view>

namespace canyon {

/// What the line of names in RTKLIB's .pos files says ("%  GPST  latitude(deg) ...", rtklib's solution.c, outsolhead),
/// in names of core/tables/state_table.h.
struct RtklibHeader {
  std::string columns;  ///< separated by commas; the first two are `date` and `clock`, or `gps_week` and `sow`
  bool utc = false;
};

/// `line`: the names, without the percent sign; `row`: the first line of numbers, which tells dates from weeks.
RtklibHeader rtklib_header(std::string_view line, std::string_view row);

/// Whether a line with a percent sign before it holds the names.
bool is_rtklib_header(std::string_view line);

}  // namespace canyon
