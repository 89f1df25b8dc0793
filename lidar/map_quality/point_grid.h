#pragma once

#include <cstdint>
#include <span>
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
  /// Whether a point is nearer than reach_m.
  bool comes_within(const Eigen::Vector3d& p, double reach_m) const;
  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  double cell_m() const { return cell_m_; }

  /// Cells that hold points, in a fixed order.
  std::size_t cells() const { return cells_.size(); }
  /// Points of a cell, and of all cells that touch it, its own among them: all that lies within cell_m of its points.
  std::span<const Eigen::Vector3f> points_of(std::size_t cell) const;
  std::vector<std::span<const Eigen::Vector3f>> around(std::size_t cell) const;

 private:
  /// x, y and z in 21 bits each, from -2^20 on; beyond that cells flow into one another, which costs time alone.
  using Key = std::uint64_t;
  using Coordinates = Eigen::Matrix<std::int64_t, 3, 1>;
  struct Cell {
    Key key;
    std::uint32_t begin, end;
  };
  Coordinates coordinates_of(const Eigen::Vector3d& p) const;
  const Cell* find(const Coordinates& at) const;
  /// Calls visit(k) for the place in cell order of every point of the cells that a ball touches, until it is true.
  template <class Visit>
  void visit_ball(const Eigen::Vector3d& p, double reach_m, const Visit& visit) const;

  double cell_m_;
  std::vector<Eigen::Vector3f> points_;   // as they were given
  std::vector<Eigen::Vector3f> ordered_;  // cell by cell
  std::vector<std::uint32_t> order_;      // their indices
  std::vector<Cell> cells_;               // by key
  std::vector<std::uint32_t> slots_;      // of cells; open addressing, a power of two, at most half full
};

}  // namespace canyon::lidar
