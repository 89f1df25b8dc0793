#include "canyon/gnss/atmosphere/niell.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

using ByLatitude = std::array<double, 5>;  // 15, 30, 45, 60, 75 deg

// Niell (1996), table 3: hydrostatic, average and seasonal amplitude.
constexpr ByLatitude kAverageA{1.2769934e-3, 1.2683230e-3, 1.2465397e-3, 1.2196049e-3, 1.2045996e-3};
constexpr ByLatitude kAverageB{2.9153695e-3, 2.9152299e-3, 2.9288445e-3, 2.9022565e-3, 2.9024912e-3};
constexpr ByLatitude kAverageC{62.610505e-3, 62.837393e-3, 63.721774e-3, 63.824265e-3, 64.258455e-3};
constexpr ByLatitude kAmplitudeA{0.0, 1.2709626e-5, 2.6523662e-5, 3.4000452e-5, 4.1202191e-5};
constexpr ByLatitude kAmplitudeB{0.0, 2.1414979e-5, 3.0160779e-5, 7.2562722e-5, 11.723375e-5};
constexpr ByLatitude kAmplitudeC{0.0, 9.0128400e-5, 4.3497037e-5, 84.795348e-5, 170.37206e-5};
constexpr MappingCoefficients kHeight{2.53e-5, 5.49e-3, 1.14e-3};
// Table 4: wet.
constexpr ByLatitude kWetA{5.8021897e-4, 5.6794847e-4, 5.8118019e-4, 5.9727542e-4, 6.1641693e-4};
constexpr ByLatitude kWetB{1.4275268e-3, 1.5138625e-3, 1.4572752e-3, 1.5007428e-3, 1.7599082e-3};
constexpr ByLatitude kWetC{4.3472961e-2, 4.6729510e-2, 4.3908931e-2, 4.4626982e-2, 5.4736038e-2};

double at_latitude(const ByLatitude& table, double lat_rad) {
  const double x = std::clamp(std::abs(lat_rad) / kDegree / 15.0 - 1.0, 0.0, 4.0);
  const auto i = static_cast<std::size_t>(std::min(x, 3.0));
  const double s = x - static_cast<double>(i);
  return table[i] * (1.0 - s) + table[i + 1] * s;
}

}  // namespace

double continued_fraction(const MappingCoefficients& k, double elevation_rad) {
  const double s = std::sin(elevation_rad);
  return (1.0 + k.a / (1.0 + k.b / (1.0 + k.c))) / (s + k.a / (s + k.b / (s + k.c)));
}

MappingCoefficients niell_hydrostatic_coefficients(double lat_rad, double day_of_year) {
  const double phase = (day_of_year - 28.0) / 365.25 + (lat_rad < 0.0 ? 0.5 : 0.0);
  const double season = std::cos(2.0 * kPi * phase);
  return {at_latitude(kAverageA, lat_rad) - at_latitude(kAmplitudeA, lat_rad) * season,
          at_latitude(kAverageB, lat_rad) - at_latitude(kAmplitudeB, lat_rad) * season,
          at_latitude(kAverageC, lat_rad) - at_latitude(kAmplitudeC, lat_rad) * season};
}

MappingCoefficients niell_wet_coefficients(double lat_rad) {
  return {at_latitude(kWetA, lat_rad), at_latitude(kWetB, lat_rad), at_latitude(kWetC, lat_rad)};
}

double niell_hydrostatic(double elevation_rad, double lat_rad, double height_m, double day_of_year) {
  // The height correction 1/sin e - f(e) diverges at the horizon; Niell fitted it down to 3 deg.
  const double held_rad = std::max(elevation_rad, 3.0 * kDegree);
  const double per_km = 1.0 / std::sin(held_rad) - continued_fraction(kHeight, held_rad);
  return continued_fraction(niell_hydrostatic_coefficients(lat_rad, day_of_year), elevation_rad) +
         per_km * 1e-3 * height_m;
}

double niell_wet(double elevation_rad, double lat_rad) {
  return continued_fraction(niell_wet_coefficients(lat_rad), elevation_rad);
}

}  // namespace canyon::gnss
