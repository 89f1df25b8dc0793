#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/trajectory.h"

namespace canyon::lidar {

/// The sensor's motion through one sweep, sampled so densely that it may be read linearly: tens of thousands of rays
/// then cost a few multiplications each, not an SE(3) interpolation each.
///
/// Nodes lie at every pose of the trajectory and at most 0.25 ms apart between them, on the SE(3) geodesic. The chord
/// between nodes deviates from the arc by at most (w h)^2 / 8 in direction and a h^2 / 8 in position: at 2 rad/s and 10
/// m/s^2 3e-8 rad (3 um at 100 m) and 0.1 um.
class SweepMotion {
 public:
  /// A rigid transform as a matrix; on a chord R is orthogonal to 1e-7.
  struct Placement {
    Eigen::Matrix3d R;
    Eigen::Vector3d p;
    Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return R * x + p; }
  };

  /// X_RL(t) = X_RW * X_WB(t) * X_BL over what `motion` covers of [stamp + first_s, stamp + last_s].
  SweepMotion(const Trajectory& motion, GpsTime stamp, double first_s, double last_s, const Pose& X_RW,
              const Pose& X_BL);

  /// True if time_s, in seconds after the stamp, lies in the covered span (to 10 ns).
  bool covers(double time_s) const;

  /// Placement at time_s, which must be covered. `hint` is where the search starts and is moved along; start with 0.
  /// Fast for times that ascend from call to call.
  Placement at(double time_s, std::size_t& hint) const;

 private:
  struct Node {
    double time_s;
    Placement placement;
  };
  std::vector<Node> nodes_;  // time ascending; empty: nothing covered
};

}  // namespace canyon::lidar
