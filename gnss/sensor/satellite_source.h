#pragma once

#include <memory>
#include <string>
#include <vector>

#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/sensor/sensor.h"

namespace canyon::gnss {

/// The satellites that a configuration names.
struct SatelliteSource {
  std::unique_ptr<Constellation> constellation;
  NavigationData navigation;  ///< what the files say; empty for the built-in constellation
  KlobucharCoefficients klobuchar = kBuiltInKlobuchar;
  std::vector<std::string> warnings;
};

/// Reads nav_file and nav_files, of `systems`, and checks that they cover [start, end]; without any file the built-in
/// constellation. Errors name file, line and key.
Result<SatelliteSource> make_satellite_source(const GnssConfig& config, GpsTime start, GpsTime end);

}  // namespace canyon::gnss
