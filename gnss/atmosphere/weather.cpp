#include "gnss/atmosphere/weather.h"

#include <algorithm>
#include <cmath>

namespace canyon::gnss {

Weather standard_weather(double height_m) {
  const double h = std::clamp(height_m, -500.0, 11000.0);
  return {1013.25 * std::pow(1.0 - 2.25577e-5 * h, 5.25588), 15.0 - 6.5e-3 * h, 0.5};
}

double vapour_pressure_hpa(const Weather& w) {
  return w.relative_humidity * 6.112 * std::exp(17.62 * w.temperature_c / (243.12 + w.temperature_c));
}

}  // namespace canyon::gnss
