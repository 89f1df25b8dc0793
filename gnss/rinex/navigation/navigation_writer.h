#pragma once

#include <string>

#include "canyon/core/result.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// A mixed RINEX 3.04 navigation file of the ephemerides: GPS and QZSS LNAV, Galileo I/NAV and F/NAV, BeiDou D1 and D2,
/// GLONASS FDMA, in the order of satellite and time; Klobuchar coefficients and leap seconds in the header. Numbers
/// have 13 digits, which moves an orbit by less than 0.1 mm. RINEX 3.04 has no records for CNAV and its relatives, nor
/// for GLONASS's delta tau: they are left out. An Error where a clock's epoch is no whole second, which RINEX 3 cannot
/// say.
Result<std::string> navigation_file_text(const NavigationData& data);

/// Whether RINEX 3.04 has a record for that message.
bool is_in_rinex3(NavigationMessage message);

}  // namespace canyon::gnss
