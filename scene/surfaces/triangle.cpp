#include "canyon/scene/surfaces/triangle.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"

namespace canyon::scene {

Eigen::Vector3d Triangle::closest_point(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;

  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + (d1 / (d1 - d3)) * ab;

  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;

  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + (d2 / (d2 - d6)) * ac;

  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);

  const double denominator = va + vb + vc;
  return a + (vb / denominator) * ab + (vc / denominator) * ac;
}

bool Triangle::usable() const {
  for (const Eigen::Vector3d& p : {a, b, c})
    if (!(p.array().abs() <= kFarthest_m).all()) return false;
  const double longest_m = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  return area_normal().norm() > 1e-6 * longest_m;
}

std::size_t drop_unusable_triangles(Mesh& mesh) {
  std::size_t kept = 0;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % 65536 == 0) throw_if_cancelled();
    if (!Triangle::of(mesh, i).usable()) continue;
    mesh.triangles[kept] = mesh.triangles[i];
    mesh.material[kept] = mesh.material[i];
    mesh.object[kept] = mesh.object[i];
    ++kept;
  }
  const std::size_t dropped = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  mesh.material.resize(kept);
  mesh.object.resize(kept);
  return dropped;
}

}  // namespace canyon::scene
