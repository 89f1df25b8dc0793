#include "gnss/single_point/ionosphere_map.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "gnss/atmosphere/ionosphere.h"

namespace canyon::gnss {

double ionosphere_map_delay_m(const IonexMaps& maps, const SkyView& view) {
  const double ratio = maps.base_radius_m / (maps.base_radius_m + maps.shell_height_m);
  const double zenith_rad = 0.5 * kPi - view.elevation_rad;
  const double shell_zenith_rad = std::asin(ratio * std::sin(zenith_rad));
  // Sphere: the pierce point lies the difference of the zenith angles away, in the satellite's azimuth.
  const double away_rad = zenith_rad - shell_zenith_rad;
  const double lat = view.receiver.lat_rad;
  const double sin_lat = std::clamp(
      std::sin(lat) * std::cos(away_rad) + std::cos(lat) * std::sin(away_rad) * std::cos(view.azimuth_rad), -1.0, 1.0);
  const double lon = view.receiver.lon_rad + std::atan2(std::sin(view.azimuth_rad) * std::sin(away_rad) * std::cos(lat),
                                                        std::cos(away_rad) - std::sin(lat) * sin_lat);
  return vertical_ionosphere_m(maps.vtec_tecu(std::asin(sin_lat), lon, view.t)) / std::cos(shell_zenith_rad);
}

}  // namespace canyon::gnss
