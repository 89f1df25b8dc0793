#include "canyon/gnss/sensor/satellite_source.h"

#include "canyon/gnss/products/almanac_file.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"

namespace canyon::gnss {

void visit(FieldVisitor& f, SatelliteSourceConfig& c) {
  f.text("systems", c.systems, "satellite systems received, of G R E C J");
  f.file("nav_file", c.nav_file, "",
         "RINEX 2, 3 or 4 navigation file, plain or gzip; without any, the built-in constellation");
  f.files("nav_files", c.nav_files, "further navigation files, read as one with nav_file");
  f.file("almanac_file", c.almanac_file, "", "YUMA or SEM almanac, alone or beside navigation files");
}

Result<SatelliteSource> make_satellite_source(const SatelliteSourceConfig& config, GpsTime start, GpsTime end) {
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
