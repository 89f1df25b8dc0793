#include "canyon/gnss/paths/beam.h"

#include <Eigen/Geometry>

namespace canyon::gnss {

Beam::Beam(const Eigen::Vector3d& apex, const scene::Facet& facet, double wider_m) : apex_W(apex) {
  auto c = facet.rectangle_W;
  if (wider_m > 0.0) {
    const Eigen::Vector3d u = wider_m * (c[1] - c[0]).normalized(), v = wider_m * (c[3] - c[0]).normalized();
    c[0] -= u + v, c[1] += u - v, c[2] += u + v, c[3] += v - u;
  }
  const Eigen::Vector3d middle_W = 0.25 * (c[0] + c[1] + c[2] + c[3]) - apex;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d n = (c[k] - apex).cross(c[(k + 1) % 4] - apex);
    const double length = n.norm();
    inward_W[k] = length > 0.0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::Zero();
    if (inward_W[k].dot(middle_W) < 0.0) inward_W[k] = -inward_W[k];
  }
}

}  // namespace canyon::gnss
