#pragma once

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::mission {

/// A box that lies anyhow in W.
struct OrientedBox {
  Pose X_WC;               ///< its middle and axes
  Eigen::Vector3d half_m;  ///< half its edges

  double radius_m() const { return half_m.norm(); }
};

/// The vehicle's body: as long, wide and high as [vehicle] says, from its ground clearance on.
OrientedBox body_box(const VehicleConfig& vehicle, const Pose& X_WB);

/// Whether they have a point in common, their borders included: no axis separates them, of the box's three, the
/// triangle's normal and the nine products of their edges (S. Gottschalk, Separating axis theorem, UNC TR96-024, 1996).
bool touch(const OrientedBox& box, const scene::Triangle& triangle);

/// Their distance, 0 where they touch: exact, by the corners of each against the other, and edge against edge.
double distance_m(const OrientedBox& box, const scene::Triangle& triangle);

}  // namespace canyon::mission
