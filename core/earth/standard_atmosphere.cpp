#include "canyon/core/earth/standard_atmosphere.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon {
namespace {

// ISO 2533:1975: sea level, lapse rate of the troposphere, specific gas constant of air.
constexpr double kPressure_pa = 101325.0;
constexpr double kTemperature_k = 288.15;
constexpr double kLapse_k_m = 0.0065;
constexpr double kGas_j_kg_k = 287.05287;
constexpr double kExponent = kStandardGravity / (kGas_j_kg_k * kLapse_k_m);
constexpr double kLowest_m = -2000.0, kHighest_m = 11000.0;

}  // namespace

double standard_pressure_pa(double height_m) {
  const double h = std::clamp(height_m, kLowest_m, kHighest_m);
  return kPressure_pa * std::pow(1.0 - kLapse_k_m * h / kTemperature_k, kExponent);
}

double standard_height_m(double pressure_pa) {
  const double h = kTemperature_k / kLapse_k_m * (1.0 - std::pow(pressure_pa / kPressure_pa, 1.0 / kExponent));
  return std::clamp(h, kLowest_m, kHighest_m);
}

}  // namespace canyon
