#include "canyon/gnss/atmosphere/ionosphere_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere.h"

namespace canyon::gnss {
namespace {

/// One shell at 450 km over 6371 km whose TEC is `at_equator` + `per_degree` times the latitude, all day.
IonexMaps maps(double at_equator, double per_degree) {
  IonexMaps out;
  out.lat_first_deg = 90.0;
  out.lat_step_deg = -90.0;
  out.lon_first_deg = -180.0;
  out.lon_step_deg = 180.0;
  out.latitudes = out.longitudes = 3;
  for (const int hour : {0, 24}) {
    IonexMaps::Map map{GpsTime::from_calendar(2020, 6, 25, 0, 0, 0) + 3600.0 * hour, {}};
    for (int row = 1; row >= -1; --row)
      for (int column = 0; column < 3; ++column) map.vtec_tecu.push_back(at_equator + per_degree * 90.0 * row);
    out.maps.push_back(map);
  }
  return out;
}

SkyView view_of(double lat_deg, double azimuth_deg, double elevation_deg) {
  return {GpsTime::from_calendar(2020, 6, 25, 12, 0, 0),
          {lat_deg * kDegree, 0.3, 0.0},
          elevation_deg * kDegree,
          azimuth_deg * kDegree};
}

TEST(IonosphereMap, ConstantMapIsTheThinShell) {
  for (const double e_deg : {5.0, 30.0, 90.0}) {
    const double s = 6371.0 / 6821.0 * std::cos(e_deg * kDegree);
    EXPECT_NEAR(ionosphere_map_delay_m(maps(12.0, 0.0), view_of(50, 77, e_deg)),
                vertical_ionosphere_m(12.0) / std::sqrt(1.0 - s * s), 1e-12);
  }
}

// Due north or south the pierce point lies psi = 90 deg - e - asin(R cos e / (R + h)) away on the meridian.
TEST(IonosphereMap, PiercesTheShellInTheDirectionOfTheSatellite) {
  const double e = 20.0 * kDegree, s = 6371.0 / 6821.0 * std::cos(e);
  const double psi_deg = (0.5 * kPi - e - std::asin(s)) / kDegree;
  for (const double sign : {1.0, -1.0})
    EXPECT_NEAR(ionosphere_map_delay_m(maps(50.0, 0.3), view_of(40, sign > 0 ? 0 : 180, 20)),
                vertical_ionosphere_m(50.0 + 0.3 * (40.0 + sign * psi_deg)) / std::sqrt(1.0 - s * s), 1e-9);
}

}  // namespace
}  // namespace canyon::gnss
