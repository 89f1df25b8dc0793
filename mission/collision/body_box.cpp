#include "canyon/mission/collision/body_box.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace canyon::mission {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// In the box's own frame.
Corners corners_in(const OrientedBox& box, const scene::Triangle& triangle) {
  const Pose X_CW = box.X_WC.inverse();
  return {X_CW * triangle.a, X_CW * triangle.b, X_CW * triangle.c};
}

bool separates(const Eigen::Vector3d& axis, const Corners& t, const Eigen::Vector3d& half_m) {
  const double reach = half_m.dot(axis.cwiseAbs());
  const double p0 = axis.dot(t[0]), p1 = axis.dot(t[1]), p2 = axis.dot(t[2]);
  return std::min({p0, p1, p2}) > reach || std::max({p0, p1, p2}) < -reach;
}

bool touch_in_frame(const Eigen::Vector3d& half_m, const Corners& t) {
  const std::array<Eigen::Vector3d, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  for (int i = 0; i < 3; ++i)
    if (separates(Eigen::Vector3d::Unit(i), t, half_m)) return false;
  if (separates(edges[0].cross(edges[1]), t, half_m)) return false;
  for (int i = 0; i < 3; ++i)
    for (const Eigen::Vector3d& edge : edges)
      if (separates(Eigen::Vector3d::Unit(i).cross(edge), t, half_m)) return false;  // a null axis separates nothing
  return true;
}

/// Squared distance of two segments, from p along u and from q along v (V. J. Lumelsky, On fast computation of distance
/// between line segments, Inf. Proc. Lett. 21, 1985).
double squared_m2(const Eigen::Vector3d& p, const Eigen::Vector3d& u, const Eigen::Vector3d& q,
                  const Eigen::Vector3d& v) {
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const Eigen::Vector3d w = p - q;
  const double across = uu * vv - uv * uv;
  double s = across > 1e-14 * uu * vv ? std::clamp((uv * v.dot(w) - vv * u.dot(w)) / across, 0.0, 1.0) : 0.0;
  const double t = vv > 0.0 ? std::clamp((uv * s + v.dot(w)) / vv, 0.0, 1.0) : 0.0;
  if (uu > 0.0) s = std::clamp((uv * t - u.dot(w)) / uu, 0.0, 1.0);
  return (w + s * u - t * v).squaredNorm();
}

}  // namespace

OrientedBox body_box(const VehicleConfig& vehicle, const Pose& X_WB) {
  const double bottom_m = std::min(vehicle.ground_clearance_m, vehicle.height_m);
  const Eigen::Vector3d middle(0.5 * vehicle.wheelbase_m, 0.0, 0.5 * (bottom_m + vehicle.height_m));
  return {{X_WB.R, X_WB * middle},
          0.5 * Eigen::Vector3d(vehicle.length_m, vehicle.width_m, vehicle.height_m - bottom_m)};
}

bool touch(const OrientedBox& box, const scene::Triangle& triangle) {
  return touch_in_frame(box.half_m, corners_in(box, triangle));
}

double distance_m(const OrientedBox& box, const scene::Triangle& triangle) {
  const Corners t = corners_in(box, triangle);
  const Eigen::Vector3d& h = box.half_m;
  if (touch_in_frame(h, t)) return 0.0;
  double least_m2 = 1e300;
  for (const Eigen::Vector3d& corner : t)
    least_m2 = std::min(least_m2, (corner.cwiseAbs() - h).cwiseMax(0.0).squaredNorm());
  const scene::Triangle in_frame{t[0], t[1], t[2]};
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d corner((k & 1) != 0 ? h.x() : -h.x(), (k & 2) != 0 ? h.y() : -h.y(),
                                 (k & 4) != 0 ? h.z() : -h.z());
    least_m2 = std::min(least_m2, (in_frame.closest_point(corner) - corner).squaredNorm());
    for (int axis = 0; axis < 3; ++axis) {
      if ((k >> axis & 1) != 0) continue;  // each edge from its lower end
      const Eigen::Vector3d along = 2.0 * h[axis] * Eigen::Vector3d::Unit(axis);
      for (std::size_t i = 0; i < 3; ++i)
        least_m2 = std::min(least_m2, squared_m2(corner, along, t[i], t[(i + 1) % 3] - t[i]));
    }
  }
  return std::sqrt(least_m2);
}

}  // namespace canyon::mission
