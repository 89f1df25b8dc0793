#pragma once

#include "canyon/core/messages.h"
#include "canyon/core/motion/trajectory.h"

namespace canyon::lidar {

/// Moves every point to the sensor frame at the scan's stamp, using the buffered motion (normally the filter's own):
/// p' = X_WL(t)^-1 X_WL(t + time_s) p. Points whose time the buffer does not cover, or that are not
/// finite, are dropped.
/// Returned points are in L at the stamp with time_s = 0.
LidarScan deskew(const LidarScan& scan, const Trajectory& motion, const Pose& X_BL);

}  // namespace canyon::lidar
