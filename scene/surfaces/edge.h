#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// A straight edge at which a solid ends: roof edge, corner of a house, border of a sheet.
struct Edge {
  Eigen::Vector3d a_W, b_W;
  /// Outward normals of the two faces that meet there; of a sheet's border: of its two sides.
  Eigen::Vector3d normal_1_W, normal_2_W;
  Eigen::Vector3d outward_W;                     ///< unit, across the edge, away from the solid
  std::uint16_t material_1 = 0, material_2 = 0;  ///< of those faces, index into Scene::materials()
};

/// Convex edges of a scene and a spatial index over them.
class EdgeIndex {
 public:
  EdgeIndex() = default;
  explicit EdgeIndex(std::vector<Edge> edges);

  const std::vector<Edge>& edges() const { return edges_; }
  /// An edge, where its middle is, and half of its length.
  struct Outline {
    std::uint32_t edge;
    Eigen::Vector3d middle_W;
    double half_m;
  };
  /// Edges that from p come to within sqrt(2 detour_m x distance) of some direction at least `elevation_rad` above W's
  /// horizontal, in a fixed order: those at which a wave from there may bend towards p with no larger detour. Whatever
  /// hides them. Cost grows with what stands out.
  void shading(const Eigen::Vector3d& p_W, double elevation_rad, double detour_m, std::vector<Outline>& out) const;
  void shading(const Eigen::Vector3d& p_W, double elevation_rad, double detour_m,
               std::vector<std::uint32_t>& out) const;

  /// A straight way from a place, and how far in front of it what goes that way comes from.
  struct Way {
    Eigen::Vector3d from_W, towards_W;  ///< unit
    double length_m;                    ///< may be infinite
    double behind_m = 0.0;              ///< >= 0
  };
  /// Edges at which what goes a way may bend with no larger detour, in a fixed order, and few others: a point of them
  /// lies d on along the way from where it comes from, and within sqrt(2 detour_m d + detour_m^2) of it.
  void along(const Way& way, double detour_m, std::vector<std::uint32_t>& out) const;

 private:
  /// A square of the ground and how far what lies in it reaches.
  struct Square {
    double x_m, y_m;
    double reach_m = 0.0;  ///< no edge of it comes farther from the center, horizontally
    double top_m = -1e300, bottom_m = 1e300;
    void add(const Edge& edge);
  };
  /// With what is asked of the edges whose middles lie in it, by columns, which are filled up to whole rows.
  struct Block : Square {
    std::vector<std::uint32_t> edges;
    std::vector<double> middle_x_m, middle_y_m, middle_z_m, half_m;
    std::vector<double> level_half_m, edge_top_m;  ///< half of the length in plan; the higher end
    void take(const Edge& edge, std::uint32_t index);
    void fill_up();
  };
  /// Blocks of a large square, so that of a wide scene only what is near or high is looked at closely.
  struct Tile : Square {
    std::vector<Block> blocks;
    std::vector<double> block_x_m, block_y_m, block_reach_m;  ///< of the blocks, filled up to whole rows
    std::vector<double> block_top_m, block_bottom_m;
    void fill_up();
    template <class Take>
    void blocks_along(const Way& way, double detour_m, const Take& take) const;
  };
  template <class Take>
  void find_shading(const Eigen::Vector3d& p_W, double elevation_rad, double detour_m, const Take& take) const;

  std::vector<Edge> edges_;
  std::vector<Tile> tiles_;
};

class Scene;
/// Edges of at least `min_length_m` of everything but terrain and trees, where two triangles of one object meet at more
/// than 15 degrees, or where one ends alone. In a fixed order: by object, then by triangle.
std::vector<Edge> convex_edges(const Scene& scene, double min_length_m);

}  // namespace canyon::scene
