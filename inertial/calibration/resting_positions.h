#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/inertial/imu_log.h"

namespace canyon::inertial {

/// A stretch of a log in which the unit rested.
struct RestingPosition {
  std::size_t begin = 0, end = 0;                                                   ///< samples [begin, end)
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();  ///< means, rad/s and m/s^2
};

/// Stretches of at least `shortest_s` whose accelerometer and gyroscope are as quiet as in the log's quietest windows
/// (half a second; within three times the standard deviation of the quietest tenth). Half a window is taken off each
/// end. A pause between two turns shorter than that is not seen.
std::vector<RestingPosition> resting_positions(const ImuLog& log, double shortest_s = 2.0);

}  // namespace canyon::inertial
