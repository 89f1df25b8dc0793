#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/motion/trajectory.h"

namespace canyon::lidar {

/// By whose motion a scan is deskewed (the motion within one revolution).
enum class Deskewing {
  kPrediction,  ///< the filter's, by prediction alone
  kEstimate,    ///< the filter's estimates as they came, corrections by fixes among them
  kNone,        ///< none: points stay where they were measured
  kTruth        ///< the true motion
};
/// "prediction", "estimate", "none", "truth", in this order.
std::vector<std::string> deskewing_names();
Deskewing deskewing(std::string_view name);

/// Moves every point to the sensor frame at the scan's stamp, using the buffered motion (normally the filter's own):
/// p' = X_WL(t)^-1 X_WL(t + time_s) p. Points whose time the buffer does not cover, or that are not
/// finite, are dropped.
/// Returned points are in L at the stamp with time_s = 0.
LidarScan deskew(const LidarScan& scan, const Trajectory& motion, const Pose& X_BL);
/// Points as they were measured, those that are not finite dropped, with time_s = 0.
LidarScan not_deskewed(const LidarScan& scan);

}  // namespace canyon::lidar
