#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/messages.h"
#include "canyon/core/result.h"

namespace canyon::gnss {

/// One epoch of a receiver's NMEA 0183 log: place, quality, satellites and HDOP from its GGA, speed and course from its
/// RMC. The position in RMC has no height and is not taken.
struct NmeaRecord {
  GpsTime t;
  int quality = 0;  ///< GGA: 0 no fix, 1 single, 2 differential, 4 RTK fixed, 5 RTK float, 6 dead reckoning
  Geodetic place;   ///< ellipsoidal height: altitude + geoid separation
  int satellites = 0;
  double hdop = kNaN;
  double speed_m_s = kNaN;
  double course_rad = kNaN;  ///< from true north, clockwise
};

struct NmeaFile {
  /// In file order. Epochs before the first date (RMC, ZDA) are left out; those without GGA have quality 0.
  std::vector<NmeaRecord> records;
  std::int64_t damaged_lines = 0;     ///< wrong checksum or fields that do not parse
  std::vector<std::string> warnings;  ///< `file:line: what`, the first few damaged lines
};

/// Reads a log, plain or gzip. Sentences other than GGA, RMC and ZDA are passed over. An Error if there is not one GGA
/// or RMC in it.
///
/// `day`: midnight of the first epoch's UTC day, for logs of GGA alone, which carry no date.
Result<NmeaFile> read_nmea_file(const std::string& path, std::optional<GpsTime> day = std::nullopt);
Result<NmeaFile> parse_nmea(std::string_view text, const std::string& file_name,
                            std::optional<GpsTime> day = std::nullopt);

}  // namespace canyon::gnss
