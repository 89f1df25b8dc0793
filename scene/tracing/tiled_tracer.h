#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "canyon/scene/scene.h"
#include "canyon/scene/tracing/tracer.h"

namespace canyon::scene {

/// Ray tracing over a scene of any size. A scene that is wider than kWide_m, or reaches that far from W's origin, is
/// cut into square tiles, each with an acceleration structure about its own middle, where single precision resolves
/// 0.03 mm; 10 km from W's origin it resolves 1 mm. A triangle belongs to every tile that its bounding box meets. A ray
/// is followed from tile to tile, so nothing is left out, near or far: hits are those without tiles, but for rays
/// within a millimetre of an edge.
///
/// A tile is made when the first ray needs it. Where rays pass above all that stands in a tile it is not needed, so in
/// a large scene only the tiles around the vehicle are made, and far ones that are high enough to hide a satellite.
/// Results do not depend on which tiles were made before, or by which thread.
///
/// Where 512 m would make more than kMostTiles of them, or put the triangles into far too many each, edges are doubled
/// until they do not. That takes a scene wider than 260 km, or thousands of triangles that are kilometres long.
class TiledTracer {
 public:
  static constexpr double kWide_m = 2000.0;
  static constexpr double kTile_m = 512.0;
  static constexpr double kMostTiles = 262144.0;

  TiledTracer(const SceneParts& parts, const Extent& extent);

  /// The middle of the tile that p lies in, at height 0; W's origin in a scene without tiles.
  Eigen::Vector3d center(const Eigen::Vector3d& p_W) const;
  std::size_t tiles() const { return tiles_.size(); }
  std::size_t tiles_made() const;

  // As SceneAt's.
  Hit trace(const Ray& ray) const;
  void trace(std::span<const Ray> rays, std::span<Hit> hits) const;
  void trace(std::span<const RayPacket> rays, std::span<HitPacket> hits, const Eigen::Vector3d& origin_W) const;
  bool occluded(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, float min_m, float max_m,
                std::uint32_t mask) const;
  NearestSurface nearest(const Eigen::Vector3d& p_W, double max_m) const;
  std::uint32_t terrain_triangle(double x, double y) const;

 private:
  struct Tile {
    Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
    mutable std::vector<std::uint32_t> triangles{};  ///< until the tracer is made
    double bottom_m = std::numeric_limits<double>::infinity(), top_m = -bottom_m;
    mutable std::once_flag once;
    mutable std::unique_ptr<const Tracer> tracer;
  };
  /// Also of one tile, where a small scene lies far from the origin: its tree is about its own middle.
  bool tiled() const { return tiled_; }
  int column(double x_m) const;
  int row(double y_m) const;
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  /// Null where the scene has nothing.
  const Tile* tile(int column, int row) const { return tiles_[index(column, row)].get(); }
  double middle_x_m(int column) const { return west_m_ + (column + 0.5) * edge_m_; }
  double middle_y_m(int row) const { return south_m_ + (row + 0.5) * edge_m_; }
  void lay_out(const Extent& extent);
  const Tracer& tracer(const Tile& tile) const;
  /// Calls visit(tile, span) for the tiles that hold something at the ray's height, in the order in which the ray
  /// passes them, until it returns true.
  template <class Visit>
  void follow(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, double from_m, double to_m,
              const Visit& visit) const;
  Hit trace(const Ray& ray, double from_m) const;

  const SceneParts& parts_;
  bool tiled_ = false;
  double edge_m_ = kTile_m;
  double west_m_ = 0.0, south_m_ = 0.0;  ///< the corner of the first tile
  int columns_ = 1, rows_ = 1;
  std::vector<std::unique_ptr<Tile>> tiles_;  ///< row by row from the south
};

}  // namespace canyon::scene
