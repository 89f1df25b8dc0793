#pragma once

#include <cstdint>
#include <span>

#include "canyon/core/motion/rotation.h"

namespace canyon::lidar::trials {

/// The mix of trials: every place with every sensor and every ring, as often. Changing it changes what the figures of
/// docs/registration.md mean.
struct Sensor {
  const char* name;  ///< table in lidar/beams
  std::int64_t azimuth_steps;
};
std::span<const Sensor> sensors();

/// How far guesses are off: uniformly in the plane, by distance and direction, and about the vertical, to either side;
/// normally in height and tilt.
struct Ring {
  const char* name;
  double from_m, to_m, from_deg, to_deg;
  /// Second moments of xi, truth = guess Exp(xi): the covariance that the prior says.
  Matrix6d law() const;
};
std::span<const Ring> rings();
inline constexpr double kGuessUp_m = 0.1;
inline constexpr double kGuessTilt_deg = 0.5;

/// Sensors of a pair stand up to so far and so much turned apart, and this high.
inline constexpr double kApart_m = 3.0;
inline constexpr double kApart_deg = 10.0;
inline constexpr double kHeight_m = 1.8;
inline constexpr double kRangeNoise_m = 0.02;

}  // namespace canyon::lidar::trials
