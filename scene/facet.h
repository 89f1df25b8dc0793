#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// A planar polygon (possibly with several triangles, possibly not convex) that reflects as one mirror.
struct Facet {
  Eigen::Vector3d normal_W;  ///< unit, outward
  double offset_m = 0.0;     ///< normal . x = offset on the plane
  double area_m2 = 0.0;
  std::uint16_t material = 0;
  std::uint32_t object = 0;
  Eigen::Vector3d center_W;  ///< of the bounding sphere
  double radius_m = 0.0;
  std::vector<std::uint32_t> triangles;  ///< indices into the mesh
};

/// Planar facets of a scene and a spatial index over them.
class FacetIndex {
 public:
  FacetIndex() = default;
  explicit FacetIndex(std::vector<Facet> facets);

  const std::vector<Facet>& facets() const { return facets_; }
  /// Facets whose bounding sphere comes within `radius_m` of `p_W`, in ascending index order. Cost grows with what is
  /// near.
  void near(const Eigen::Vector3d& p_W, double radius_m, std::vector<std::uint32_t>& out) const;

 private:
  struct Cells {
    int column0, column1, row0, row1;
  };
  Cells cells_around(const Eigen::Vector3d& p_W, double radius_m) const;
  std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  std::vector<Facet> facets_;
  // Uniform 2-D grid over x, y; each cell lists the facets whose bounding square overlaps it, in ascending order.
  double cell_m_ = 0.0;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint32_t>> cells_;
};

class Scene;
/// Merges coplanar triangles of one object and material that share an edge (normal within 0.1 deg of the facet's
/// largest triangle, corners within 1 cm of its plane) into facets; drops facets smaller than `min_area_m2`. Terrain
/// and trees do not become facets. Facets come in a fixed order: by object, then by their lowest triangle.
std::vector<Facet> merge_planar_facets(const Scene& scene, double min_area_m2);
/// True if a point on the facet's plane lies inside the facet (within 1e-9 of an edge counts as inside).
bool facet_contains(const Facet& facet, const Scene& scene, const Eigen::Vector3d& p_W);

}  // namespace canyon::scene
