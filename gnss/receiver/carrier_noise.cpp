#include "canyon/gnss/receiver/carrier_noise.h"

#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {

double carrier_phase_noise_rad(double cn0_dbhz, double carrier_loop_hz, double integration_s) {
  const double cn0_hz = std::pow(10.0, cn0_dbhz / 10.0);
  return std::sqrt(carrier_loop_hz / cn0_hz * (1.0 + 0.5 / (integration_s * cn0_hz)));
}

double doppler_noise_hz(double cn0_dbhz, double carrier_loop_hz, double integration_s) {
  const double cn0_hz = std::pow(10.0, cn0_dbhz / 10.0);
  return std::sqrt(4.0 * carrier_loop_hz / cn0_hz * (1.0 + 1.0 / (integration_s * cn0_hz))) /
         (2.0 * kPi * integration_s);
}

}  // namespace canyon::gnss
