#include "canyon/core/earth/local_frame.h"

namespace canyon {

LocalFrame::LocalFrame() : LocalFrame(Geodetic{}) {}

LocalFrame::LocalFrame(const Geodetic& origin)
    : origin_(origin), R_EW_(rotation_E_from_enu(origin)), origin_E_(ecef_from_geodetic(origin)) {}

Eigen::Vector3d LocalFrame::to_E(const Eigen::Vector3d& p_W) const {
  return origin_E_ + R_EW_ * p_W;
}

Eigen::Vector3d LocalFrame::to_W(const Eigen::Vector3d& p_E) const {
  return R_EW_.transpose() * (p_E - origin_E_);
}

Geodetic LocalFrame::to_geodetic(const Eigen::Vector3d& p_W) const {
  return geodetic_from_ecef(to_E(p_W));
}

Eigen::Vector3d LocalFrame::from_geodetic(const Geodetic& g) const {
  return to_W(ecef_from_geodetic(g));
}

Pose LocalFrame::X_EW() const {
  return {Eigen::Quaterniond(R_EW_), origin_E_};
}

}  // namespace canyon
