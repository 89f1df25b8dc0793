#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "canyon/core/random/random.h"

namespace canyon::lidar::testing {

/// The ground about a recording sensor, in its frame L: where normal.dot(p) + below_m is 0.
struct GroundPlane {
  Eigen::Vector3d normal{0, 0, 1};
  double below_m = 0.0;  ///< of L's origin

  double height_m(const Eigen::Vector3d& p_L) const { return normal.dot(p_L) + below_m; }
  /// Of a return so far off, on a street that is not quite a plane.
  bool holds(const Eigen::Vector3d& p_L) const { return std::abs(height_m(p_L)) < 0.15 + 0.01 * p_L.norm(); }
  /// Where a beam meets it, m; 1e9: nowhere.
  double range_m(const Eigen::Vector3d& along_L) const {
    const double falls = -along_L.dot(normal);
    return falls > 1e-3 ? below_m / falls : 1e9;
  }
};

/// Through what lies lower than 0.8 m under the origin within 10 m: drawn triples, the one that most lies on, and a
/// least-squares plane of these.
inline GroundPlane ground_under(const std::vector<Eigen::Vector3d>& points_L) {
  std::vector<Eigen::Vector3d> low;
  for (const Eigen::Vector3d& p : points_L)
    if (p.head<2>().norm() < 10.0 && p.z() < -0.8) low.push_back(p);
  const RandomStream draws(1, "test.ground");
  const auto one_of = [&](std::uint32_t n, std::uint64_t k) {
    return low[static_cast<std::size_t>(draws.uniform(n, k) * static_cast<double>(low.size()))];
  };
  GroundPlane best;
  std::size_t most = 0;
  for (std::uint64_t k = 0; k < 300 && !low.empty(); ++k) {
    const Eigen::Vector3d a = one_of(0, k);
    Eigen::Vector3d n = (one_of(1, k) - a).cross(one_of(2, k) - a);
    if (n.norm() < 1e-6) continue;
    n = n.normalized() * (n.z() < 0.0 ? -1.0 : 1.0);
    const GroundPlane plane{n, -n.dot(a)};
    const auto count = static_cast<std::size_t>(std::count_if(
        low.begin(), low.end(), [&](const Eigen::Vector3d& p) { return std::abs(plane.height_m(p)) < 0.05; }));
    if (n.z() > 0.97 && count > most) most = count, best = plane;
  }
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : low) {
    if (std::abs(best.height_m(p)) >= 0.06) continue;
    const Eigen::Vector3d row(p.x(), p.y(), 1.0);
    A += row * row.transpose();
    b += row * p.z();
  }
  const Eigen::Vector3d z = A.ldlt().solve(b);
  const double length = std::hypot(1.0, z.head<2>().norm());
  return {Eigen::Vector3d(-z.x(), -z.y(), 1.0) / length, -z.z() / length};
}

}  // namespace canyon::lidar::testing
