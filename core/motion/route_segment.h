#pragma once

#include <vector>

#include <Eigen/Core>

namespace canyon {

/// A piece of the planned route, for which a model states whether it is needed (study/plan).
struct RouteSegment {
  std::vector<Eigen::Vector3d> points_W;  ///< polyline, m
  double start_s = 0.0;                   ///< nominal time from mission start
  double end_s = 0.0;
  double speed_m_s = 0.0;
};

}  // namespace canyon
