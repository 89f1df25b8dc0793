#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// A straight piece of a facet's border; seen from outside the facet lies to its left.
struct FacetBorder {
  Eigen::Vector3d from_W, to_W;
};

/// A planar polygon (possibly with several triangles, possibly not convex) that reflects as one mirror.
struct Facet {
  Eigen::Vector3d normal_W;  ///< unit, outward
  double offset_m = 0.0;     ///< normal . x = offset on the plane
  double area_m2 = 0.0;
  std::uint16_t material = 0;
  std::uint32_t object = 0;
  Eigen::Vector3d center_W;  ///< of the bounding sphere
  double radius_m = 0.0;
  double bottom_m = 0.0, top_m = 0.0;  ///< lowest and highest z
  double flatness_m = 0.0;             ///< no corner is farther from the plane than this
  /// Bounding rectangle in the plane, counter-clockwise seen from outside; one side lies along an edge of one of
  /// its first triangles. `fills_rectangle`: the facet covers it whole (but for 1e-6 of its area).
  std::array<Eigen::Vector3d, 4> rectangle_W;
  bool fills_rectangle = false;
  std::vector<std::uint32_t> triangles;  ///< indices into the mesh
  std::vector<FacetBorder> borders;      ///< where triangles end that no other one of the facet continues
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
  /// Facets that could mirror a plane wave from some direction at least `elevation_rad` (0 to pi/2, above W's
  /// horizontal) high towards p, in a fixed order. If the facet's normal points up by t, the mirrored wave arrives from
  /// an elevation between elevation - 2 t and 180 deg - elevation - 2 t; if it points down, from no lower than
  /// `elevation`. So a wall must stand up above `elevation` seen from p, a roof must lie below. Those which meet this
  /// are listed, whichever way they face and whatever hides them, but none farther away than `reach_per_area_1_m` (may
  /// be infinite) times its area, and none that leans back, as pitched roofs do, farther away than `leaning_reach_m`
  /// (nothing else limits those: the wave may come down from them level). With `detour_m` those too over whose border
  /// the wave may pass on a way that is longer by no more. Cost grows with what stands out.
  void mirrors(const Eigen::Vector3d& p_W, double elevation_rad, double reach_per_area_1_m, double leaning_reach_m,
               std::vector<std::uint32_t>& out, double detour_m = 0.0) const;

 private:
  struct Cells {
    int column0, column1, row0, row1;
  };
  Cells cells_around(const Eigen::Vector3d& p_W, double radius_m) const;
  std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  /// What the search for mirrors looks at of a facet, in a row.
  struct Brief {
    float x_m, y_m, radius_m, bottom_m, top_m, area_m2;
    std::uint32_t facet;
  };
  /// A square of the ground and what may be asked of all facets whose centers lie in it at once.
  struct Square {
    double x_m, y_m;                ///< center
    double reach_m = 0.0;           ///< no facet of it comes farther from the center, horizontally
    double area_m2 = 0.0;           ///< largest
    double upright_top_m = -1e300;  ///< of what does not lean back
    void add(const Facet& facet, bool leans_back);
  };
  /// Facets of a small square, sorted into classes of lean.
  struct Block : Square {
    struct Class {
      std::size_t lean = 0;
      double bottom_m = 1e300, top_m = -1e300;
      double area_m2 = 0.0;  ///< largest
      std::vector<Brief> facets;
    };
    std::vector<Class> classes;
  };
  /// Blocks of a large square, so that of a wide scene only what is near or high is looked at closely.
  struct Tile : Square {
    std::vector<Block> blocks;
  };
  void build_tiles();

  std::vector<Facet> facets_;
  std::vector<Tile> tiles_;
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
