#include "canyon/gnss/sensor/satellite_source.h"

#include "canyon/gnss/products/almanac_file.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"

namespace canyon::gnss {

Result<SatelliteSource> make_satellite_source(const GnssConfig& config, GpsTime start, GpsTime end) {
  CANYON_TRY_STATUS(check_systems(config.systems, "gnss.systems"));
  SatelliteSource source;
  std::vector<std::string> files = config.nav_files;
  if (!config.nav_file.empty()) files.insert(files.begin(), config.nav_file);
  if (files.empty() && config.almanac_file.empty()) {
    source.constellation = make_nominal(config.systems);
    return source;
  }
  if (!files.empty()) {
    CANYON_TRY(source.navigation, read_navigation_files(files));
  }
  if (!config.almanac_file.empty()) {
    CANYON_TRY(auto almanac, read_almanac_file(config.almanac_file, start));
    source.navigation.append(std::move(almanac));
  }
  CANYON_TRY_STATUS(check_coverage(source.navigation, config.systems, start, end, "gnss.nav_file"));
  source.warnings = source.navigation.warnings;
  if (const std::string skipped = source.navigation.skipped(); !skipped.empty())
    source.warnings.push_back(source.navigation.names() + ": records that are not used: " + skipped);
  source.constellation = make_broadcast(source.navigation, {.systems = config.systems});
  source.klobuchar = source.navigation.klobuchar_at(GnssSystem::kGps, start).value_or(kBuiltInKlobuchar);
  return source;
}

}  // namespace canyon::gnss
