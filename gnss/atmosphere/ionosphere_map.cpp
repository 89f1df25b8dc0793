#include "canyon/gnss/atmosphere/ionosphere_map.h"

#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere.h"

namespace canyon::gnss {

double ionosphere_map_delay_m(const IonexMaps& maps, const SkyView& view) {
  const double ratio = maps.base_radius_m / (maps.base_radius_m + maps.shell_height_m);
  const double sin_zenith = ratio * std::cos(view.elevation_rad);  // at the shell
  // Angle at the Earth's centre between receiver and pierce point.
  const double away_rad = 0.5 * kPi - view.elevation_rad - std::asin(sin_zenith);
  const double sin_lat = std::sin(view.receiver.lat_rad), cos_lat = std::cos(view.receiver.lat_rad);
  const double east = std::sin(away_rad) * std::sin(view.azimuth_rad);
  const double out = std::cos(away_rad) * cos_lat - std::sin(away_rad) * std::cos(view.azimuth_rad) * sin_lat;
  const double up = std::cos(away_rad) * sin_lat + std::sin(away_rad) * std::cos(view.azimuth_rad) * cos_lat;
  const double lat_rad = std::atan2(up, std::hypot(east, out));
  const double lon_rad = std::remainder(view.receiver.lon_rad + std::atan2(east, out), 2.0 * kPi);
  return vertical_ionosphere_m(maps.vtec_tecu(lat_rad, lon_rad, view.t)) / std::sqrt(1.0 - sin_zenith * sin_zenith);
}

}  // namespace canyon::gnss
