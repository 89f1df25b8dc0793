#include "canyon/tests/lidar/registration/trials/mix.h"

#include <cmath>

#include "canyon/core/units.h"

namespace canyon::lidar::trials {
namespace {

constexpr Sensor kSensors[] = {{"vlp16", 1800}, {"hdl32e", 1800}, {"os1_128", 512}};
constexpr Ring kRings[] = {{"0-1 m 0-3 deg", 0, 1, 0, 3},
                           {"1-2 m 3-10 deg", 1, 2, 3, 10},
                           {"2-4 m 10-20 deg", 2, 4, 10, 20},
                           {"4-8 m 20-30 deg", 4, 8, 20, 30}};

/// Of a number uniform in [a, b].
double mean_square(double a, double b) {
  return (a * a + a * b + b * b) / 3.0;
}

}  // namespace

std::span<const Sensor> sensors() {
  return kSensors;
}
std::span<const Ring> rings() {
  return kRings;
}

Matrix6d Ring::law() const {
  const double tilt2 = std::pow(kGuessTilt_deg * kDegree, 2), plane2 = 0.5 * mean_square(from_m, to_m);
  Matrix6d P = Matrix6d::Zero();
  P.diagonal() << tilt2, tilt2, mean_square(from_deg, to_deg) * kDegree * kDegree, plane2, plane2,
      kGuessUp_m * kGuessUp_m;
  return P;
}

}  // namespace canyon::lidar::trials
