#pragma once

namespace canyon::gnss {

/// a, b, c of a continued fraction (1 + a/(1 + b/(1 + c))) / (s + a/(s + b/(s + c))), s = sin(elevation).
struct MappingCoefficients {
  double a = 0.0, b = 0.0, c = 0.0;
};
double continued_fraction(const MappingCoefficients& k, double elevation_rad);

/// Coefficients of Niell (1996), "Global mapping functions for the atmosphere delay at radio wavelengths", tables 3 and
/// 4, by latitude and day of year (1.0 = 1 January 00:00); the hydrostatic ones follow the seasons, half a year later
/// in the south.
MappingCoefficients niell_hydrostatic_coefficients(double lat_rad, double day_of_year);
MappingCoefficients niell_wet_coefficients(double lat_rad);

/// Slant over zenith delay. Made for elevations from 3 deg up, finite from 0. The hydrostatic one has Niell's height
/// correction.
double niell_hydrostatic(double elevation_rad, double lat_rad, double height_m, double day_of_year);
double niell_wet(double elevation_rad, double lat_rad);

}  // namespace canyon::gnss
