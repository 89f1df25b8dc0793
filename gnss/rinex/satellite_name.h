#pragma once

#include <optional>
#include <string_view>

#include "core/messages.h"

namespace canyon::gnss {

/// The system of a RINEX letter, G R E C J S.
std::optional<GnssSystem> system_of_letter(char letter);
/// "G05", "R 1"; " 5" with a blank letter is GPS. nullopt for systems that are not known here, and numbers outside
/// 1-99.
std::optional<SatelliteId> satellite_of_name(std::string_view text);

}  // namespace canyon::gnss
