#include "canyon/lidar/ego_mask.h"

#include <algorithm>
#include <limits>

namespace canyon::lidar {

void visit(FieldVisitor& f, EgoConfig& c) {
  f.vector3("ego_min_m", c.min_m, {-100, 100}, "box in the body that hides the vehicle itself: lowest corner");
  f.vector3("ego_max_m", c.max_m, {-100, 100}, "its highest corner; the same as ego_min_m = no box");
}

EgoMask::EgoMask(const EgoConfig& box, const Pose& X_BL)
    : min_B_(box.min_m), max_B_(box.max_m), X_BL_(X_BL), any_(((box.max_m - box.min_m).array() > 0).all()) {}

void EgoMask::hide(const AimPacket& aim, scene::RayPacket& rays) const {
  for (std::size_t i = 0; i < AimPacket::kShots; ++i) {
    const Eigen::Vector3d o = X_BL_ * Eigen::Vector3d(aim.origin_x[i], aim.origin_y[i], aim.origin_z[i]);
    const Eigen::Vector3d d = X_BL_.R * Eigen::Vector3d(aim.direction_x[i], aim.direction_y[i], aim.direction_z[i]);
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      if (d[k] == 0.0) {
        if (o[k] < min_B_[k] || o[k] > max_B_[k]) leave = -1.0;
        continue;
      }
      const double a = (min_B_[k] - o[k]) / d[k], b = (max_B_[k] - o[k]) / d[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter <= leave) rays.max_m[i] = -1.0f;
  }
}

}  // namespace canyon::lidar
