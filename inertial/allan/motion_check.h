#pragma once

#include <vector>

#include "canyon/inertial/imu_log.h"

namespace canyon::inertial {

/// A stretch of a log in which the unit moves, and how that shows.
struct MovingInterval {
  double from_s = 0.0, to_s = 0.0;  ///< the log's own time
  int channel = 0;                  ///< that shows it most, 0..5 as in ImuLog
  bool shakes = false;              ///< by its scatter within a second; else by its mean over a second
  double amount = 0.0;              ///< scatter, or how far the mean is from that at rest; rad/s or m/s^2
  double excess = 0.0;              ///< the amount over what rest allows
};

struct MotionFound {
  std::vector<MovingInterval> intervals;  ///< in order of time, at least a second apart
  double share = 0.0;                     ///< of the log's time

  bool moves() const { return !intervals.empty(); }
  /// The one furthest beyond what rest allows. There must be one.
  const MovingInterval& worst() const;
};

/// Where a log that ought to rest moves: seconds (or ten samples, if that is longer) in which the mean of a channel is
/// off the log's median by more than bias and its drift can be - 1 deg/s, or 0.5 m/s^2, a tilt of 3 degrees - or in
/// which its scatter is five times that of the log's quietest seconds and more than 0.5 deg/s or 0.1 m/s^2, or is more
/// than 5 deg/s or 1.5 m/s^2, which no unit's noise is. A unit that turns evenly all the time shows nothing but a bias,
/// and is taken to move if that is more than 10 deg/s. A steady speed is rest to an inertial sensor, and slower motions
/// are not told from drift.
MotionFound find_motion(const ImuLog& log);

}  // namespace canyon::inertial
