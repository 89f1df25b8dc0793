#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

namespace canyon::lidar {

/// Points in cubes of one size, for questions about what lies within a bounded distance. Points must be finite.
class PointGrid {
 public:
  /// `cell_m` > 0: questions are best asked with reaches near it.
  PointGrid(std::span<const Eigen::Vector3f> points, double cell_m);

  /// Distance to the nearest point, `reach_m` where none is nearer.
  double nearest_m(const Eigen::Vector3d& p, double reach_m) const;
  /// Indices of all points within reach_m, in ascending order; replaces what is in `out`.
  void within(const Eigen::Vector3d& p, double reach_m, std::vector<std::uint32_t>& out) const;
  const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Cell& c) const;
  };
  Cell cell_of(const Eigen::Vector3d& p) const;
  /// Calls visit(index) for every point of the cells that a ball touches.
  template <class Visit>
  void visit_ball(const Eigen::Vector3d& p, double reach_m, const Visit& visit) const;

  double cell_m_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<std::uint32_t> order_;  // indices, cell by cell
  struct Range {
    std::uint32_t begin, end;
  };
  std::unordered_map<Cell, Range, Hash> cells_;
};

}  // namespace canyon::lidar
