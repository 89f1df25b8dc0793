#pragma once

#include <array>
#include <string>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/result.h"
#include "canyon/core/units.h"
#include "canyon/inertial/calibration/fitted_entry.h"

/// The figures of a unit out of its own log, in three ways: at rest, in resting positions, beside a reference.
namespace canyon::inertial {

/// A log and the file it is from, which errors name and sources state.
struct NamedLog {
  ImuLog log;
  std::string path;
};

/// What an accelerometer at rest is compared with, and how that is known.
struct LocalGravity {
  double m_s2 = kStandardGravity;
  std::string source = "standard gravity, 9.80665 m/s^2";
};
LocalGravity given_gravity(double m_s2);
/// WGS84 normal gravity.
LocalGravity gravity_at(const Geodetic& place);

/// Samples of a log and what a reference says at their times.
struct ReferencePairs {
  std::vector<double> t_s;                                      ///< of the log
  std::array<std::vector<Eigen::Vector3d>, 2> measured, truth;  ///< gyroscope, accelerometer: rad/s and m/s^2
};
/// Both hold means over the interval that ends at the stamp, so a reference at another rate belongs to other middles;
/// it is interpolated there, linearly, but not across its gaps. Both logs have all six channels.
ReferencePairs reference_pairs(const ImuLog& log, const ImuLog& truth);

/// Noise and bias of a unit that rests; an accelerometer is needed. The Earth's rate counts as the gyroscope's bias.
Result<FittedUnit> fit_at_rest(const NamedLog& log, const LocalGravity& gravity);

/// Bias, scale factors and misalignments of both triads against true rates or increments at the same times; the noise
/// is that of what the calibration leaves, the reference's included. All six channels are needed of both.
Result<FittedUnit> fit_to_truth(const NamedLog& log, const NamedLog& truth);

/// The accelerometer against gravity in nine or more resting positions, the gyroscope's bias and the noise of all from
/// the same rests. All six channels are needed.
Result<FittedUnit> fit_to_positions(const NamedLog& log, const LocalGravity& gravity);

}  // namespace canyon::inertial
