#include "canyon/gnss/paths/beam.h"

#include <Eigen/Geometry>

namespace canyon::gnss {

Beam::Beam(const Eigen::Vector3d& apex, const scene::Facet& facet) : apex_W(apex) {
  const auto& c = facet.rectangle_W;
  const Eigen::Vector3d middle_W = 0.25 * (c[0] + c[1] + c[2] + c[3]) - apex;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d n = (c[k] - apex).cross(c[(k + 1) % 4] - apex);
    const double length = n.norm();
    inward_W[k] = length > 0.0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::Zero();
    if (inward_W[k].dot(middle_W) < 0.0) inward_W[k] = -inward_W[k];
  }
}

}  // namespace canyon::gnss
