#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/core/time.h"

namespace canyon::gnss {

/// Maps of the vertical total electron content on a grid of latitude and longitude, of one shell.
struct IonexMaps {
  struct Map {
    GpsTime t;
    std::vector<double> vtec_tecu;  ///< rows of latitude from first to last, in each longitudes; NaN = no value
  };
  std::string name;
  double shell_height_m = 450e3;
  double base_radius_m = 6371e3;
  double lat_first_deg = 0.0, lat_step_deg = 0.0, lon_first_deg = 0.0, lon_step_deg = 0.0;
  std::size_t latitudes = 0, longitudes = 0;
  std::vector<Map> maps;  ///< ascending in time
  std::vector<std::string> warnings;

  /// Vertical TEC at a geographic point of the shell. Bilinear on each of the two maps around t, which are first turned
  /// with the Sun (Schaer, Gurtner, Feltens 1998, equation 3), then linear in time. NaN outside the time of the maps
  /// and where a grid point needed has no value; beyond the first and last latitude the nearest row is used.
  double vtec_tecu(double lat_rad, double lon_rad, GpsTime t) const;
};

/// Reads IONEX 1.0 or 1.1 of two dimensions, plain or gzip; epochs are UTC. RMS and height maps are passed over. A
/// damaged map is skipped with a warning that names its line; errors with file and line: not IONEX, a header without a
/// grid, no map.
Result<IonexMaps> read_ionex_file(const std::string& path);
Result<IonexMaps> parse_ionex_file(std::string_view text, const std::string& file_name);

}  // namespace canyon::gnss
