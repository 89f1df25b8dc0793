#pragma once

#include <Eigen/Core>

#include "canyon/scene/farthest.h"
#include "canyon/scene/scene.h"

namespace canyon::scene {

/// One triangle of a mesh in double precision. Corners are counter-clockwise seen from outside.
struct Triangle {
  Eigen::Vector3d a, b, c;

  static Triangle of(const Mesh& mesh, std::uint32_t index) {
    const auto& t = mesh.triangles[index];
    return {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(), mesh.vertices[t[2]].cast<double>()};
  }

  /// Not normalised; its length is twice the area.
  Eigen::Vector3d area_normal() const { return (b - a).cross(c - a); }
  /// Nearest point of the triangle, its inside and edges included (Ericson, Real-Time Collision Detection,
  /// 2005, 5.1.5).
  Eigen::Vector3d closest_point(const Eigen::Vector3d& p) const;
  /// Within kFarthest_m, and no altitude is below 1 micrometre.
  bool usable() const;
};

/// Drops the triangles that no ray can meet (not usable()), and counts them.
std::size_t drop_unusable_triangles(Mesh& mesh);

}  // namespace canyon::scene
