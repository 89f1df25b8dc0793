#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/motion/trajectory.h"
#include "canyon/lidar/beam/aim.h"

namespace canyon::lidar {

/// The sensor's motion through one sweep, sampled so densely that it may be read linearly: tens of thousands of rays
/// then cost a few multiplications each, not an SE(3) interpolation each.
///
/// Nodes lie at every pose of the trajectory and between them on the SE(3) geodesic, so close that a chord deviates
/// from the arc by at most 3e-8 rad (3 um at 100 m) and 1 um, up to 5000 deg/s.
class SweepMotion {
 public:
  /// A rigid transform as a matrix; on a chord R is orthogonal to 1e-7.
  struct Placement {
    Eigen::Matrix3d R;
    Eigen::Vector3d p;  ///< follows R in memory
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

  /// Placements at time_s + i * step_s, i = 0..15, with the rates at the middle; times outside are taken to be the
  /// nearest covered. Something must be covered.
  void placements(double time_s, double step_s, std::size_t& hint, PlacementPacket& out) const;

 private:
  struct Node {
    double time_s;
    Placement placement;
  };
  /// Index of the node before time_s, which another follows; moves `hint`. More than one node.
  std::size_t before(double time_s, std::size_t& hint) const;
  std::vector<Node> nodes_;  // time ascending; empty: nothing covered
};

}  // namespace canyon::lidar
