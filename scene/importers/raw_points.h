#pragma once

#include <vector>

#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/raw_scene.h"

namespace canyon::scene {

/// A point of what was read, and what is said of it where it is wrong.
struct RawPoint {
  Eigen::Vector3d p;
  RawPlace from;
  std::uint32_t object = 0xffffffffu;  ///< index into RawScene::objects; else a vertex of a mesh, or a street
  std::size_t vertex = 0;              ///< of a mesh, counted from 1
};

/// Calls body(RawPoint) for every corner of a surface or outline; of meshes for the vertices that a triangle uses. The
/// height of a footprint is that of its ground, NaN where that is not known.
template <class Body>
void for_corners(const RawScene& scene, const Body& body) {
  for (const RawPolygon& polygon : scene.polygons) {
    throw_if_cancelled();
    for (const auto& ring : polygon.rings)
      for (const Eigen::Vector3d& p : ring) body(RawPoint{p, polygon.from, polygon.object});
  }
  for (const RawMesh& mesh : scene.meshes) {
    throw_if_cancelled();
    std::vector<bool> used(mesh.vertices.size(), false);
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle) used[v] = true;
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (v % 65536 == 0) throw_if_cancelled();
      if (!used[v]) continue;
      RawPoint point{mesh.vertices[v], {mesh.file, v < mesh.line.size() ? mesh.line[v] : 0}};
      point.vertex = v + 1;
      body(point);
    }
  }
  for (const RawFootprint& f : scene.footprints) {
    throw_if_cancelled();
    for (const Eigen::Vector2d& p : f.rings[0])
      body(RawPoint{Eigen::Vector3d(p.x(), p.y(), f.ground_m), f.from, f.object});
  }
}

/// The same for the courtyards of footprints, which lie within their outlines unless the file is damaged.
template <class Body>
void for_courtyard_corners(const RawScene& scene, const Body& body) {
  for (const RawFootprint& f : scene.footprints) {
    throw_if_cancelled();
    for (std::size_t ring = 1; ring < f.rings.size(); ++ring)
      for (const Eigen::Vector2d& p : f.rings[ring])
        body(RawPoint{Eigen::Vector3d(p.x(), p.y(), f.ground_m), f.from, f.object});
  }
}

/// The same for streets and trees, which have no height.
template <class Body>
void for_street_points_and_trees(const RawScene& scene, const Body& body) {
  const double no_height = std::numeric_limits<double>::quiet_NaN();
  for (const RawStreet& street : scene.streets) {
    throw_if_cancelled();
    for (const Eigen::Vector2d& p : street.points)
      body(RawPoint{Eigen::Vector3d(p.x(), p.y(), no_height), street.from});
  }
  for (const RawTree& tree : scene.trees) {
    throw_if_cancelled();
    body(RawPoint{Eigen::Vector3d(tree.place.x(), tree.place.y(), no_height), tree.from, tree.object});
  }
}

/// "vertex 7", "building 12", "street".
inline std::string name_of(const RawPoint& point, const RawScene& scene) {
  if (point.object < scene.objects.size()) return scene.objects[point.object].name;
  return point.vertex > 0 ? "vertex " + std::to_string(point.vertex) : "street";
}

}  // namespace canyon::scene
