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
  bool covers(double time_s) const {
    return !nodes_.empty() && time_s >= nodes_.front().time_s - kTimeTolerance_s &&
           time_s <= nodes_.back().time_s + kTimeTolerance_s;
  }

  /// Placement at time_s, which must be covered. `hint` is where the search starts and is moved along; start with 0.
  /// Fast for times that ascend from call to call.
  Placement at(double time_s, std::size_t& hint) const;

  /// at(), the same bits, for many times that mostly ascend: what lies between two nodes is taken once for all of them.
  class Reader {
   public:
    explicit Reader(const SweepMotion& motion) : motion_(motion) {}
    Placement at(double time_s) {
      if (!(time_s >= from_s_ && time_s < to_s_)) find(time_s);
      if (stands_) return from_;
      const double s = (time_s - from_s_) / length_s_;
      return {from_.R + s * way_.R, from_.p + s * way_.p};
    }

   private:
    void find(double time_s);
    const SweepMotion& motion_;
    std::size_t hint_ = 0;
    double from_s_ = 0.0, to_s_ = 0.0, length_s_ = 1.0;
    bool stands_ = false;  ///< a single node
    Placement from_, way_;
  };

  /// Placements at time_s + i * step_s, i = 0..15, with the rates at the middle; times outside are taken to be the
  /// nearest covered. Something must be covered.
  void placements(double time_s, double step_s, std::size_t& hint, PlacementPacket& out) const;

 private:
  static constexpr double kTimeTolerance_s = 1e-8;  // a point's time_s in single precision: 4 ns at 0.1 s
  struct Node {
    double time_s;
    Placement placement;
  };
  /// Index of the node before time_s, which another follows; moves `hint`. More than one node.
  std::size_t before(double time_s, std::size_t& hint) const;
  std::vector<Node> nodes_;  // time ascending; empty: nothing covered
};

}  // namespace canyon::lidar
