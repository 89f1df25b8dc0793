#pragma once

#include <numbers>

namespace canyon {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180.0;              ///< rad
inline constexpr double kHour = 3600.0;                     ///< s
inline constexpr double kStandardGravity = 9.80665;         ///< m/s^2, exact by definition (CGPM 1901)
inline constexpr double kMilliG = 1e-3 * kStandardGravity;  ///< m/s^2
inline constexpr double kSpeedOfLight = 299'792'458.0;      ///< m/s, exact
inline constexpr double kBoltzmann = 1.380649e-23;          ///< J/K, exact (SI 2019)

}  // namespace canyon
