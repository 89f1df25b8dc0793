#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace canyon::gnss {

/// `$` + body + `*` + checksum (exclusive or of the body's bytes, two hexadecimal digits) + CR LF, as NMEA 0183 sends
/// it.
std::string nmea_sentence(std::string_view body);

/// The comma-separated fields of a line, the address ("GPGGA") first. nullopt unless the line starts with `$` and its
/// checksum is there and right.
std::optional<std::vector<std::string_view>> nmea_fields(std::string_view line);

}  // namespace canyon::gnss
