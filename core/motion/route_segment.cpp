#include "canyon/core/motion/route_segment.h"

#include <algorithm>
#include <cmath>

namespace canyon {

double RouteSegment::distance_m(const Eigen::Vector2d& p_W) const {
  double least_m = (p_W - points_W.front().head<2>()).norm();
  for (std::size_t i = 1; i < points_W.size(); ++i) {
    const Eigen::Vector2d a = points_W[i - 1].head<2>(), along = points_W[i].head<2>() - a;
    const double square = along.squaredNorm();
    const double share = square > 0.0 ? std::clamp((p_W - a).dot(along) / square, 0.0, 1.0) : 0.0;
    least_m = std::min(least_m, (p_W - a - share * along).norm());
  }
  return least_m;
}

bool RouteSegment::contains(const Pose& X_WB) const {
  const Eigen::Vector3d& p = X_WB.p;
  const double cos_tilt = (X_WB.R * Eigen::Vector3d::UnitZ()).z();
  return cos_tilt >= std::cos(kMostTilt_rad) && p.z() >= low_m && p.z() <= high_m &&
         distance_m(p.head<2>()) <= half_width_m;
}

}  // namespace canyon
