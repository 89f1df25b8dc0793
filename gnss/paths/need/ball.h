#pragma once

#include <Eigen/Core>

namespace canyon::gnss {

/// A ball in W: the place of something that is not known better, or the room that a surface takes.
struct Ball {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

}  // namespace canyon::gnss
