#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/triangle.h"

/// Scenes small enough for closed forms, and the slow, double-precision oracle.
namespace canyon::scene::testing {

inline SceneParts empty_parts() {
  SceneParts parts;
  parts.name = "test";
  parts.materials = builtin_materials();
  return parts;
}

/// A square of two terrain triangles at z = height + slope x, edge 2 half_m, centred at W's origin.
inline void add_plane(SceneParts& parts, double half_m, double height_m, double slope = 0.0) {
  MeshBuilder mesh(parts);
  mesh.begin_object("terrain", ObjectKind::kTerrain);
  const auto at = [&](double x, double y) { return Eigen::Vector3d(x, y, height_m + slope * x); };
  mesh.quad(at(-half_m, -half_m), at(half_m, -half_m), at(half_m, half_m), at(-half_m, half_m),
            mesh.material("asphalt"));
}

/// A building over a counter-clockwise outline that is star-shaped from its first corner.
inline void add_building(SceneParts& parts, const std::vector<Eigen::Vector2d>& outline, double bottom_m,
                         double top_m) {
  MeshBuilder mesh(parts);
  Building building;
  building.name = "building " + std::to_string(parts.buildings.size() + 1);
  building.object = mesh.begin_object(building.name, ObjectKind::kBuilding);
  building.footprint_W = outline;
  building.base_m = bottom_m;
  building.height_m = top_m - bottom_m;
  mesh.block(outline, bottom_m, top_m, mesh.material("brick"), mesh.material("concrete"));
  parts.buildings.push_back(building);
}

/// An L: the square [0, 20]^2 without its north-east quarter; area 300 m^2. Its inner corner comes first.
inline std::vector<Eigen::Vector2d> l_outline() {
  return {{10, 10}, {10, 20}, {0, 20}, {0, 0}, {20, 0}, {20, 10}};
}

/// Moeller & Trumbore (1997) in double precision; the range along the ray, or nullopt.
inline std::optional<double> intersect(const Triangle& t, const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction) {
  const Eigen::Vector3d e1 = t.b - t.a, e2 = t.c - t.a, p = direction.cross(e2);
  const double det = e1.dot(p);
  if (det == 0.0) return std::nullopt;
  const Eigen::Vector3d s = origin - t.a;
  const double u = s.dot(p) / det;
  if (!(u >= 0.0 && u <= 1.0)) return std::nullopt;
  const Eigen::Vector3d q = s.cross(e1);
  const double v = direction.dot(q) / det;
  if (!(v >= 0.0 && u + v <= 1.0)) return std::nullopt;
  const double range_m = e2.dot(q) / det;
  return range_m >= 0.0 ? std::optional<double>(range_m) : std::nullopt;
}

/// Rounded to what a packet of rays can hold.
inline Eigen::Vector3d in_single_precision(const Eigen::Vector3d& p) {
  Eigen::Vector3d out;
  for (int k = 0; k < 3; ++k) {
    const volatile float rounded = static_cast<float>(p[k]);  // GCC 12 leaves out what is converted back at once
    out[k] = rounded;
  }
  return out;
}

struct OracleHit {
  double range_m = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = Hit::kMiss;
};

/// Tries every triangle.
inline OracleHit trace_all(const Mesh& mesh, const Ray& ray) {
  OracleHit best;
  const Eigen::Vector3d direction = ray.direction.cast<double>();
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto range_m = intersect(Triangle::of(mesh, i), ray.origin, direction);
    if (range_m && *range_m < best.range_m && *range_m <= ray.max_m) best = {*range_m, i};
  }
  return best;
}

/// Distance from a point to the nearest edge of a triangle.
inline double edge_distance(const Triangle& t, const Eigen::Vector3d& p) {
  double best = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d corners[] = {t.a, t.b, t.c};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = corners[k], way = corners[(k + 1) % 3] - a;
    const double s = std::min(1.0, std::max(0.0, way.dot(p - a) / way.squaredNorm()));
    best = std::min(best, (a + s * way - p).norm());
  }
  return best;
}

}  // namespace canyon::scene::testing
