#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "canyon/scene/ground/ground_detail.h"

namespace canyon::scene {

/// Height of the ground at a place of W; nullopt where it is not known.
using GroundHeight = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// What a ground is asked to be.
struct GroundWish {
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();  ///< what it must cover, in W
  double cell_m = 5.0;                                                            ///< edge of a cell in full detail
  double full_m = 60.0;  ///< full detail that far around what stands and streets
};

/// The cells of a ground before it is made: a quadtree over a grid of W. Cells within full_m of what stands are single
/// cells of the grid. A cell of edge e may be larger where nothing stands within full_m + 1.5 e and, of a ground whose
/// heights are known everywhere, where heights sampled inside it differ from its triangles by no more than kSlope of
/// their distance from what stands: seen from there the ground's rise is off by a milliradian at most. Cells that touch
/// differ by a factor of two at most. The number of cells follows what stands, not the rectangle.
///
/// Large cells may reach beyond the rectangle; the cells in full detail end with it, in whole cells.
class GroundPlan {
 public:
  static constexpr double kGrade = 1.5;  ///< >= sqrt(2): cells that touch then differ by a factor of two at most
  static constexpr double kSlope = 1e-3;

  struct Cell {
    std::int32_t column, row, size;  ///< south-west corner and edge, in cells of full detail
  };

  /// `height` is asked inside cells that may be large; empty: heights far from what stands are a guess, and nothing is
  /// lost. Where far more cells come out than `most_cells`, dividing
  /// stops: cells() is larger than that then, and nothing else may be asked.
  GroundPlan(const GroundWish& wish, const GroundDetail& detail, const GroundHeight& height, double most_cells);

  double x(std::int32_t column) const { return west_m_ + column * cell_m_; }
  double y(std::int32_t row) const { return south_m_ + row * cell_m_; }
  /// How many cells there are; known before they are listed.
  double cells() const { return count_; }
  /// The cells, rows from the south, each from the west.
  std::vector<Cell> list() const;

 private:
  enum class Kind : std::uint8_t { kLeaf, kSplit, kFull, kOutside };
  struct Node {
    Kind kind = Kind::kLeaf;
    std::uint32_t first_child = 0;  ///< of four: south-west, south-east, north-west, north-east
  };
  using Squares = std::vector<GroundDetail::Square>;

  bool outside(const Cell& cell) const { return cell.column >= columns_ || cell.row >= rows_; }
  static Cell child(const Cell& cell, int k) {
    const std::int32_t half = cell.size / 2;
    return {cell.column + (k % 2) * half, cell.row + (k / 2) * half, half};
  }
  double full_cells(const Cell& cell) const;
  void divide(std::uint32_t node, const Cell& cell, const Squares& around, const GroundHeight& height);
  bool even(const Cell& cell, double distance_m, const GroundHeight& height);
  std::uint32_t split(std::uint32_t node);
  void balance();
  bool balance(std::uint32_t node, const Cell& cell);
  std::int32_t finest(std::uint32_t node, const Cell& cell, const Cell& low, std::int32_t width, std::int32_t depth,
                      std::int32_t enough) const;
  template <class Visit>
  void visit(std::uint32_t node, const Cell& cell, const Visit& visit_cell) const;

  double west_m_, south_m_, cell_m_, full_m_, most_cells_, count_ = 0.0;
  std::int32_t columns_, rows_;  ///< cells of full detail that cover the rectangle
  Cell root_;
  std::vector<Node> nodes_;
};

}  // namespace canyon::scene
