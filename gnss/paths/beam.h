#pragma once

#include <array>

#include <Eigen/Core>

#include "canyon/scene/surfaces/facet.h"

namespace canyon::gnss {

/// The pyramid from an apex through a facet's bounding rectangle, its sides so much farther out.
struct Beam {
  Eigen::Vector3d apex_W;
  std::array<Eigen::Vector3d, 4> inward_W;  ///< unit normals of its sides; all zero if the apex lies in the plane

  Beam(const Eigen::Vector3d& apex_W, const scene::Facet& facet, double wider_m = 0.0);

  /// False only if the whole ball lies outside of one side.
  bool may_meet(const Eigen::Vector3d& center_W, double radius_m) const {
    const Eigen::Vector3d v = center_W - apex_W;
    for (const Eigen::Vector3d& n : inward_W)
      if (n.dot(v) < -radius_m) return false;
    return true;
  }
};

}  // namespace canyon::gnss
