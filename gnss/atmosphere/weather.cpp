#include "canyon/gnss/atmosphere/weather.h"

#include <algorithm>
#include <cmath>

namespace canyon::gnss {

Weather standard_weather(double height_m) {
  constexpr double kTropopauseM = 11000.0;
  const double h = std::clamp(height_m, -500.0, 20000.0), low = std::min(h, kTropopauseM);
  const double pressure_hpa = 1013.25 * std::pow(1.0 - 2.25577e-5 * low, 5.25588);
  // Scale height of air at -56.5 deg C: R T / g = 287.053 * 216.65 / 9.80665.
  return {pressure_hpa * std::exp(-(h - low) / 6341.62), 15.0 - 6.5e-3 * low, 0.5};
}

Weather MeasuredWeather::at(double to_m) const {
  const Weather here = standard_weather(height_m), there = standard_weather(to_m);
  return {weather.pressure_hpa * there.pressure_hpa / here.pressure_hpa,
          weather.temperature_c + there.temperature_c - here.temperature_c, weather.relative_humidity};
}

double vapour_pressure_hpa(const Weather& w) {
  return w.relative_humidity * 6.112 * std::exp(17.62 * w.temperature_c / (243.12 + w.temperature_c));
}

}  // namespace canyon::gnss
