#pragma once

#include "canyon/core/time.h"
#include "canyon/gnss/satellites/klobuchar_coefficients.h"

namespace canyon::gnss {

/// Slant delay at L1, m, for a receiver at geodetic latitude and longitude that sees a satellite at azimuth (from
/// north, clockwise) and elevation in [0, pi/2].
double klobuchar_delay_m(const KlobucharCoefficients& coefficients, GpsTime t, double lat_rad, double lon_rad,
                         double azimuth_rad, double elevation_rad);

/// Its obliquity factor F = 1 + 16 (0.53 - E)^3, E in semicircles.
double klobuchar_obliquity(double elevation_rad);

}  // namespace canyon::gnss
