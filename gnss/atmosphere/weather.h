#pragma once

namespace canyon::gnss {

/// Air at the receiver.
struct Weather {
  double pressure_hpa = 1013.25;
  double temperature_c = 15.0;
  double relative_humidity = 0.5;  ///< 0..1
};

/// Standard atmosphere at a height above mean sea level: ICAO, 6.5 K per km up to 11 km and isothermal above, relative
/// humidity 50 % at every height: what a receiver without weather sensors assumes. Heights are held within [-500,
/// 20000] m.
Weather standard_weather(double height_m);

/// Weather as it was measured somewhere.
struct MeasuredWeather {
  Weather weather;
  double height_m = 0.0;  ///< above mean sea level, where it holds

  /// Carried to another height by the standard atmosphere: pressure in its proportion, temperature by its difference,
  /// relative humidity unchanged.
  Weather at(double height_m) const;
};

/// Partial pressure of water vapour, hPa: Magnus formula with the WMO (2008) constants.
double vapour_pressure_hpa(const Weather& w);

}  // namespace canyon::gnss
