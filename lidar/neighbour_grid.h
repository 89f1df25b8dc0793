#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "lidar/voxel_index.h"

namespace canyon::lidar {

/// Exact nearest neighbours within a radius, from points sorted into the cells of a grid. Faster than a tree where the
/// points are evenly spread (thinned clouds) and the radius is a few cells. Deterministic: equal distances go to the
/// lower index.
class NeighbourGrid {
 public:
  struct Neighbour {
    float squared_m;
    std::uint32_t index;
    bool operator<(const Neighbour& o) const {
      return squared_m < o.squared_m || (squared_m == o.squared_m && index < o.index);
    }
  };

  /// `cell_m`: about the spacing of the points. Points must be finite.
  NeighbourGrid(std::span<const Eigen::Vector3f> points, double cell_m);

  /// The up to `k` > 0 nearest points closer than radius_m, nearest first.
  void nearest(const Eigen::Vector3f& query, std::size_t k, double radius_m, std::vector<Neighbour>& out) const;

 private:
  struct Entry {
    float x, y, z;
    std::uint32_t index;
  };
  VoxelIndex cells_;
  std::vector<std::uint32_t> begin_;  // per cell, plus the end
  std::vector<Entry> entries_;        // by cell, within a cell by index
};

}  // namespace canyon::lidar
