#pragma once

#include "canyon/core/units.h"
#include "canyon/mission/recorder/rows.h"

namespace canyon::mission {

/// Error of a pose in W: east, north, up and, as a rotation vector in the true body, roll, pitch, yaw in degrees.
struct EstimateError {
  Eigen::Vector3d position_W_m;
  Eigen::Vector3d attitude_deg;
};

inline EstimateError estimate_error(const NavRow& row) {
  return {row.estimate.X_WB.p - row.X_WB_true.p, so3_log(row.X_WB_true.R.conjugate() * row.estimate.X_WB.R) / kDegree};
}

}  // namespace canyon::mission
