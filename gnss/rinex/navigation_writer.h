#pragma once

#include <string>

#include "gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// A mixed RINEX 3.04 navigation file of the ephemerides: GPS and QZSS LNAV, Galileo I/NAV and F/NAV, BeiDou D1 and D2,
/// GLONASS FDMA, in the order of satellite and time; Klobuchar coefficients and leap seconds in the header. Numbers
/// have 13 digits, which moves an orbit by less than 0.1 mm. RINEX 3.04 has no records for CNAV and its relatives, nor
/// for GLONASS's delta tau: they are left out. Clock epochs must be whole seconds, as the systems broadcast them; else
/// throws.
std::string navigation_file_text(const NavigationData& data);

}  // namespace canyon::gnss
