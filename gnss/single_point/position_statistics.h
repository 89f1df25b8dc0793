#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/gnss/solver/ellipse_coverage.h"

namespace canyon::gnss {

/// How fixes differ from the truth, estimate minus truth, in east, north and up at the truth. NaN where there is
/// nothing to say: no fix, or no truth. Standard deviations are about the mean, h50 and h95 percentiles of the
/// horizontal and v95 of the absolute vertical error (linear between ranks).
struct PositionStatistics {
  int epochs = 0, solved = 0, compared = 0;  ///< compared: solved epochs at which there is a truth
  Eigen::Vector3d mean_enu_m = Eigen::Vector3d::Constant(kNaN), std_enu_m = Eigen::Vector3d::Constant(kNaN);
  double h50_m = kNaN, h95_m = kNaN, v95_m = kNaN, rms_3d_m = kNaN;
  EllipseCoverage reported;                                                ///< of those with a covariance
  Eigen::Vector3d velocity_rms_enu_m_s = Eigen::Vector3d::Constant(kNaN);  ///< where fixes and truth have a velocity
};

/// True antenna at an instant.
struct TruePlace {
  Eigen::Vector3d p_E;
  std::optional<Eigen::Vector3d> v_E;
};
using Truth = std::function<std::optional<TruePlace>(GpsTime)>;

PositionStatistics position_statistics(const std::vector<GnssFix>& fixes, const Truth& truth);

}  // namespace canyon::gnss
