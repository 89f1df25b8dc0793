#pragma once

#include <memory>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// Keys of where the satellites are.
struct SatelliteSourceConfig {
  std::string systems = "G";           ///< RINEX letters of the systems received
  std::string nav_file;                ///< RINEX navigation file; none at all = built-in constellation
  std::vector<std::string> nav_files;  ///< further ones
  std::string almanac_file;            ///< YUMA or SEM, for satellites that have no ephemeris
};
void visit(FieldVisitor& f, SatelliteSourceConfig& c);

/// The satellites that a configuration names.
struct SatelliteSource {
  std::shared_ptr<const Constellation> constellation;
  NavigationData navigation;  ///< what the files say; empty for the built-in constellation
  KlobucharCoefficients klobuchar = kBuiltInKlobuchar;
  std::vector<std::string> warnings;
};

/// Reads nav_file and nav_files, of `systems`, and checks that they cover [start, end]; without any file the built-in
/// constellation. Errors name file, line and key.
Result<SatelliteSource> make_satellite_source(const SatelliteSourceConfig& config, GpsTime start, GpsTime end);

}  // namespace canyon::gnss
