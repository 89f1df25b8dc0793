#pragma once

#include <optional>
#include <string_view>

#include "canyon/gnss/rinex/observation/observation_code.h"

namespace canyon::gnss {

/// "G05", "R 1"; " 5" with a blank letter is GPS. nullopt for systems that are not known here, and numbers outside
/// 1-99.
std::optional<SatelliteId> satellite_of_name(std::string_view text);

}  // namespace canyon::gnss
