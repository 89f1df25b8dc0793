#pragma once

#include <cstdint>

namespace canyon::gnss {

/// The navigation message a broadcast ephemeris came with, named as in RINEX 4, or an almanac.
enum class NavigationMessage : std::uint8_t {
  kLnav,     ///< GPS, QZSS: L1 C/A
  kCnav,     ///< GPS, QZSS: L2C, L5
  kCnav2,    ///< GPS, QZSS: L1C
  kInav,     ///< Galileo: E1-B, E5b; clock of E1 and E5b
  kFnav,     ///< Galileo: E5a; clock of E1 and E5a
  kD1,       ///< BeiDou MEO and IGSO: B1I, B2I, B3I
  kD2,       ///< BeiDou GEO: B1I, B2I, B3I
  kBcnav1,   ///< BeiDou-3: B1C (RINEX CNV1)
  kBcnav2,   ///< BeiDou-3: B2a (RINEX CNV2)
  kFdma,     ///< GLONASS: G1, G2
  kAlmanac,  ///< GPS, QZSS: no ephemeris at all, but the almanac of one
};

/// Of BeiDou's B1I: D2 from the geostationary satellites C01 to C05 and C59 to C63, D1 from the others.
NavigationMessage beidou_message(int prn);

/// RINEX 4's name: "LNAV", "CNV1", ...
const char* name_of(NavigationMessage message);

}  // namespace canyon::gnss
