#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"

namespace canyon::mission {

/// Where the returns of one ring climb a kerb: by 6 to 30 cm within a step across the street, against the street's own
/// plane, with a level top behind. Of a deskewed scan placed in a frame whose z points up; rings may come in any order.
struct KerbTask {
  const LidarScan& scan;
  const Pose& X_OL;
  Eigen::Vector2d origin, along;  ///< a place on the street, and its direction there, unit
  double ground_m = 0.0;          ///< height of the street at the origin, about
  Eigen::Vector3d up{0, 0, 1};    ///< unit, across the street's plane there, about: the vehicle's own
  double ahead_m = 20.0;          ///< from the origin on
  double beside_m = 12.0;         ///< to either side, the pavement included
};
/// Places in that frame, at most one to a side for each ring.
std::vector<Eigen::Vector2d> kerb_rises(const KerbTask& task);

}  // namespace canyon::mission
