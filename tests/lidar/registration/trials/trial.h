#pragma once

#include <vector>

#include "canyon/lidar/registration/registration.h"
#include "canyon/tests/lidar/registration/trials/mix.h"
#include "canyon/tests/lidar/registration/trials/places.h"

namespace canyon::lidar::trials {

/// Two clouds of a place and a guess, all drawn for this trial alone.
struct Trial {
  std::vector<Eigen::Vector3f> source, target;
  Pose truth;       ///< X_TS
  PosePrior prior;  ///< its covariance is the law of the guesses
  /// Directions of xi that no surface of the place tells, source frame.
  std::vector<Vector6d> open;
  /// Other poses within the prior's 3 sigma see the same: a step of the facades on, or anywhere on level ground.
  bool ambiguous = false;
};
/// How far a guess of the ring is off: truth = guess Exp(xi).
Vector6d draw_guess(Draws& draws, const Ring& ring);
Trial make_trial(const Place& place, const Sensor& sensor, const Ring& ring, std::uint64_t seed, std::uint64_t number);

}  // namespace canyon::lidar::trials
