#include "canyon/gnss/rinex/satellite_name.h"

#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {

std::optional<SatelliteId> satellite_of_name(std::string_view text) {
  if (text.size() < 2) return std::nullopt;
  const auto system = system_of_letter(text[0]);
  const auto prn = whole_number(columns(text, 1, 2));
  if (!system || !prn || *prn < 1 || *prn > 99) return std::nullopt;
  return SatelliteId{*system, static_cast<std::uint8_t>(*prn)};
}

}  // namespace canyon::gnss
