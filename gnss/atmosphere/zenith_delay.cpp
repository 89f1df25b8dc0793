#include "canyon/gnss/atmosphere/zenith_delay.h"

#include <cmath>

namespace canyon::gnss {

double zenith_hydrostatic_m(double pressure_hpa, double lat_rad, double height_m) {
  return 0.0022768 * pressure_hpa / (1.0 - 0.00266 * std::cos(2.0 * lat_rad) - 0.00028 * 1e-3 * height_m);
}

double zenith_wet_m(double temperature_c, double vapour_pressure_hpa) {
  return 0.0022768 * (1255.0 / (temperature_c + 273.15) + 0.05) * vapour_pressure_hpa;
}

}  // namespace canyon::gnss
