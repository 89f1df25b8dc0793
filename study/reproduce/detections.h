#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/scene/scene_at.h"

namespace canyon::study {

inline constexpr double kReach_m = 20.0;  ///< a direction in which nothing is nearer is free

/// Ranges from B to the first thing, by direction: kDirections of them, 2 degrees apart, from 40 degrees to the right
/// of B's x axis to 40 degrees to the left; kReach_m where there is none.
using Ranges = std::vector<double>;
inline constexpr int kDirections = 41;

/// To the nearest of `cells` that are held to block, as seen from `p` with that heading; both in one level frame. A
/// cell lies in a direction if its middle is less than 0.2 m beside it. What is nearer than 3 m is the vehicle's own.
Ranges held_ranges(const std::vector<Eigen::Vector2d>& cells, const Eigen::Vector2d& p, double yaw_rad);

/// To the nearest of the scene's surfaces but the ground, at 0.6, 1.2 and 1.8 m above B, 3 m and more away.
Ranges true_ranges(const scene::SceneAt& scene, const Pose& X_WB);

/// Things held against things that stand, direction by direction: the same within 1 m.
class Detections {
 public:
  void add(const Ranges& held, const Ranges& truly);

  /// Of all directions: something is held to block there, and nothing is near it. NaN before add().
  double phantom_share() const;
  /// Of directions in which something stands: nothing is held to block there, or only farther off. NaN without any.
  double missed_share() const;
  /// Of ranges where there is something in both; NaN without any.
  double range_rms_m() const;

 private:
  int directions_ = 0, phantoms_ = 0, things_ = 0, missed_ = 0, both_ = 0;
  double squares_m2_ = 0.0;
};

/// How far commands are from others, row by row up to the end of the shorter; NaN of none.
struct CommandDifference {
  double steering_rms_deg = kNaN;  ///< of the angle at which a wheelbase turns by the curvature
  double speed_rms_m_s = kNaN;
};
CommandDifference command_difference(const std::vector<DriveCommand>& a, const std::vector<DriveCommand>& b,
                                     double wheelbase_m);

}  // namespace canyon::study
