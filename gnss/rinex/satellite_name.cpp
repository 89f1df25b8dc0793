#include "gnss/rinex/satellite_name.h"

#include "gnss/rinex/text_lines.h"

namespace canyon::gnss {

std::optional<GnssSystem> system_of_letter(char letter) {
  for (const GnssSystem system : {GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou,
                                  GnssSystem::kQzss, GnssSystem::kSbas})
    if (letter == system_letter(system)) return system;
  return std::nullopt;
}

std::optional<SatelliteId> satellite_of_name(std::string_view text) {
  if (text.size() < 2) return std::nullopt;
  const auto system = text[0] == ' ' ? GnssSystem::kGps : system_of_letter(text[0]);
  const auto prn = whole_number(columns(text, 1, 2));
  if (!system || !prn || *prn < 1 || *prn > 99) return std::nullopt;
  return SatelliteId{*system, static_cast<std::uint8_t>(*prn)};
}

}  // namespace canyon::gnss
