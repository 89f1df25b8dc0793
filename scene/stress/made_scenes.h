#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/triangle.h"

/// Scenes of known shape, and the slow tracer in double precision, for this room.
namespace canyon::scene::made {

inline SceneParts nothing() {
  SceneParts parts;
  parts.name = "made";
  parts.materials = builtin_materials();
  return parts;
}

inline std::unique_ptr<Scene> scene_of(SceneParts parts) {
  return std::make_unique<Scene>(std::move(parts));
}

/// A level square of two triangles, edge 2 half_m, about (x, y).
inline void add_square(SceneParts& parts, const Eigen::Vector3d& middle_W, double half_m,
                       ObjectKind kind = ObjectKind::kTerrain) {
  MeshBuilder mesh(parts);
  mesh.begin_object("square " + std::to_string(parts.objects.size()), kind);
  const auto at = [&](double x, double y) { return Eigen::Vector3d(middle_W + half_m * Eigen::Vector3d(x, y, 0)); };
  mesh.quad(at(-1, -1), at(1, -1), at(1, 1), at(-1, 1), mesh.material("asphalt"));
}

/// A wall in the plane x = x_m that faces west, `half_m` to either side and up and down.
inline void add_wall(SceneParts& parts, const Eigen::Vector3d& middle_W, double half_m) {
  MeshBuilder mesh(parts);
  mesh.begin_object("wall " + std::to_string(parts.objects.size()), ObjectKind::kWall);
  const auto at = [&](double y, double z) { return Eigen::Vector3d(middle_W + half_m * Eigen::Vector3d(0, y, z)); };
  mesh.quad(at(1, -1), at(-1, -1), at(-1, 1), at(1, 1), mesh.material("concrete"));
}

inline void add_box(SceneParts& parts, const Eigen::Vector3d& middle_W, const Eigen::Vector3d& half_m) {
  MeshBuilder mesh(parts);
  mesh.begin_object("box " + std::to_string(parts.objects.size()), ObjectKind::kBuilding);
  mesh.box(middle_W, Eigen::Matrix3d::Identity(), half_m, mesh.material("brick"));
}

struct BruteHit {
  double range_m = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = Hit::kMiss;
  double approach = 0.0;                                    ///< |normal . direction|
  double edge_m = std::numeric_limits<double>::infinity();  ///< of the nearest edge of any triangle to its crossing
};

/// Every triangle, Moeller and Trumbore (1997) in double precision.
inline BruteHit try_all(const Mesh& mesh, const Ray& ray) {
  BruteHit best;
  const Eigen::Vector3d d = ray.direction.cast<double>();
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = Triangle::of(mesh, i);
    const Eigen::Vector3d e1 = t.b - t.a, e2 = t.c - t.a, p = d.cross(e2), s = ray.origin - t.a, q = s.cross(e1);
    const double det = e1.dot(p);
    if (det == 0.0) continue;
    const double u = s.dot(p) / det, v = d.dot(q) / det, range_m = e2.dot(q) / det;
    if (!(range_m > 0.0)) continue;
    // How far the crossing of its plane is from its border, by the smallest of the barycentric heights.
    const double area2 = e1.cross(e2).norm(), longest = worse(worse(e1.norm(), e2.norm()), (t.c - t.b).norm());
    const double margin_m = std::min({u, v, 1.0 - u - v}) * area2 / longest;
    best.edge_m = std::min(best.edge_m, std::abs(margin_m));
    if (margin_m >= 0.0 && range_m < best.range_m)
      best = {range_m, i, std::abs(e1.cross(e2).normalized().dot(d)), best.edge_m};
  }
  return best;
}

}  // namespace canyon::scene::made
