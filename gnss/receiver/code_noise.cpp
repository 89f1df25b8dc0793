#include "gnss/receiver/code_noise.h"

#include <cmath>

namespace canyon::gnss {
namespace {

double shape(double cn0_dbhz, double spacing_chips) {
  constexpr double kIntegrationS = 0.020;
  const double cn0_hz = std::pow(10.0, cn0_dbhz / 10.0);
  return std::sqrt((1.0 + 2.0 / (kIntegrationS * cn0_hz * (2.0 - spacing_chips))) / cn0_hz);
}

}  // namespace

double relative_code_noise(double cn0_dbhz, double spacing_chips) {
  return shape(cn0_dbhz, spacing_chips) / shape(45.0, spacing_chips);
}

}  // namespace canyon::gnss
