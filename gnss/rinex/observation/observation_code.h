#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// A RINEX 3 observation code: kind (C pseudorange, L phase, D Doppler, S signal strength), band digit, attribute.
struct ObservationCode {
  char kind = ' ', band = ' ', attribute = ' ';
  bool operator==(const ObservationCode&) const = default;
  std::string str() const { return {kind, band, attribute}; }
};

/// Of "C1C"; nullopt if it is no code.
std::optional<ObservationCode> parse_observation_code(std::string_view text);

/// Of a RINEX 2 name ("C1", "P2", "L5") for a satellite of that system, after table A1 of RINEX 2.11 and the 2.12
/// draft: GPS C1 -> C1C, P1 -> C1W, P2 and L2 -> 2W, C2 -> C2X, C5 -> C5X; GLONASS P -> P, else C; Galileo X; BeiDou I
/// (RINEX 2 files write its B1 as band 1 or 2). nullopt for what RINEX 3 does not have.
std::optional<ObservationCode> convert_rinex2_code(std::string_view name, GnssSystem system);

/// System of a RINEX letter; a blank is GPS. nullopt for others (I, ...).
std::optional<GnssSystem> system_of_letter(char letter);

inline constexpr std::array<GnssSystem, 6> kGnssSystems{GnssSystem::kGps,    GnssSystem::kGlonass, GnssSystem::kGalileo,
                                                        GnssSystem::kBeidou, GnssSystem::kQzss,    GnssSystem::kSbas};

}  // namespace canyon::gnss
