#pragma once

#include <string>
#include <vector>

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// A satellite above the mask as GSV and GSA list it.
struct NmeaSatellite {
  SatelliteId sv;
  double elevation_rad = 0.0;
  double azimuth_rad = 0.0;  ///< from true north, clockwise
  double cn0_dbhz = kNaN;    ///< NaN: not tracked; its field stays empty
  bool used = false;         ///< in the fix
};

/// One epoch of a receiver.
struct NmeaEpoch {
  GnssFix fix;                ///< status kNone gives a GGA of quality 0 and a void RMC
  double undulation_m = 0.0;  ///< geoid above the ellipsoid at the fix
  std::vector<NmeaSatellite> satellites;
};

/// GGA, RMC, GSA (one per system), GSV (per system) of an epoch, in NMEA 0183 version 4.11, with CR LF. Times are UTC,
/// rounded to 10 ms; positions have 7 decimals of a minute (0.2 mm), WGS84. Satellites are numbered as the standard
/// numbers them: GPS 1-32, SBAS PRN - 87, GLONASS slot + 64, Galileo, BeiDou and QZSS (PRN - 192 of J01..) from 1, told
/// apart by talker and system number.
std::string nmea_text(const NmeaEpoch& epoch);

}  // namespace canyon::gnss
