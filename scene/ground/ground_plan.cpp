#include "canyon/scene/ground/ground_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "canyon/core/process/progress.h"

namespace canyon::scene {

GroundPlan::GroundPlan(const GroundWish& wish, const GroundDetail& detail, const GroundHeight& height,
                       double most_cells)
    : west_m_(wish.cell_m * std::floor(wish.low.x() / wish.cell_m)),
      south_m_(wish.cell_m * std::floor(wish.low.y() / wish.cell_m)),
      cell_m_(wish.cell_m),
      full_m_(wish.full_m),
      most_cells_(most_cells),
      columns_(std::max(1, static_cast<std::int32_t>(std::ceil((wish.high.x() - west_m_) / cell_m_)))),
      rows_(std::max(1, static_cast<std::int32_t>(std::ceil((wish.high.y() - south_m_) / cell_m_)))) {
  root_ = {0, 0, 1};
  while (root_.size < std::max(columns_, rows_)) root_.size *= 2;
  nodes_.emplace_back();
  divide(0, root_, detail.squares(), height);
  balance();
}

double GroundPlan::full_cells(const Cell& cell) const {
  return static_cast<double>(std::min(cell.column + cell.size, columns_) - cell.column) *
         static_cast<double>(std::min(cell.row + cell.size, rows_) - cell.row);
}

std::uint32_t GroundPlan::split(std::uint32_t node) {
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 4);
  nodes_[node] = {Kind::kSplit, first};
  return first;
}

void GroundPlan::divide(std::uint32_t node, const Cell& cell, const Squares& around, const GroundHeight& height) {
  throw_if_cancelled();
  if (outside(cell)) {
    nodes_[node].kind = Kind::kOutside;
    return;
  }
  const double edge_m = cell.size * cell_m_;
  const Eigen::Vector2d low(x(cell.column), y(cell.row)), high = low.array() + edge_m;
  double distance_m = std::numeric_limits<double>::infinity(), all_within_m = distance_m;
  for (const GroundDetail::Square& square : around) {
    distance_m = std::min(distance_m, nearest_m(low, high, square));
    all_within_m = std::min(all_within_m, farthest_m(low, high, square));
  }
  if (cell.size > 1 && all_within_m <= full_m_) {
    nodes_[node].kind = Kind::kFull;
    count_ += full_cells(cell);
    return;
  }
  if (cell.size == 1 || static_cast<double>(nodes_.size()) > 4.0 * most_cells_ ||
      (distance_m >= full_m_ + kGrade * edge_m && (!height || even(cell, distance_m, height)))) {
    count_ += 1.0;
    return;
  }
  // A square that is farther from all of the cell than another one is from any point of it matters no more.
  const double matter_m = distance_m + std::sqrt(2.0) * edge_m;
  Squares near;
  std::copy_if(around.begin(), around.end(), std::back_inserter(near),
               [&](const auto& square) { return nearest_m(low, high, square) <= matter_m; });
  const std::uint32_t first = split(node);
  for (int k = 0; k < 4; ++k) divide(first + static_cast<std::uint32_t>(k), child(cell, k), near, height);
}

bool GroundPlan::even(const Cell& cell, double distance_m, const GroundHeight& height) {
  constexpr std::size_t kMost = 5;
  const std::int32_t steps = cell.size >= 4 ? 4 : 2, step = cell.size / steps;
  std::array<std::array<std::optional<double>, kMost>, kMost> z;
  for (std::int32_t r = 0; r <= steps; ++r)
    for (std::int32_t c = 0; c <= steps; ++c)
      z[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] =
          height({x(cell.column + c * step), y(cell.row + r * step)});
  const auto last = static_cast<std::size_t>(steps);
  const auto &sw = z[0][0], &se = z[0][last], &nw = z[last][0], &ne = z[last][last];
  for (std::size_t r = 0; r <= last; ++r) {
    for (std::size_t c = 0; c <= last; ++c) {
      if (!z[r][c] || !sw || !se || !nw || !ne) continue;  // what is not known cannot be missed
      const double u = static_cast<double>(c) / steps, v = static_cast<double>(r) / steps;
      const double plane = u >= v ? *sw + u * (*se - *sw) + v * (*ne - *se) : *sw + v * (*nw - *sw) + u * (*ne - *nw);
      if (std::abs(*z[r][c] - plane) > kSlope * distance_m) return false;
    }
  }
  return true;
}

std::int32_t GroundPlan::finest(std::uint32_t node, const Cell& cell, const Cell& low, std::int32_t width,
                                std::int32_t depth, std::int32_t enough) const {
  constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();
  if (cell.column >= low.column + width || cell.column + cell.size <= low.column || cell.row >= low.row + depth ||
      cell.row + cell.size <= low.row)
    return kNone;
  const Node& here = nodes_[node];
  if (here.kind == Kind::kOutside) return kNone;
  if (here.kind == Kind::kFull) return 1;
  if (here.kind == Kind::kLeaf) return cell.size;
  std::int32_t least = kNone;
  for (int k = 0; k < 4 && least > enough; ++k)
    least = std::min(
        least, finest(here.first_child + static_cast<std::uint32_t>(k), child(cell, k), low, width, depth, enough));
  return least;
}

bool GroundPlan::balance(std::uint32_t node, const Cell& cell) {
  const Node here = nodes_[node];
  if (here.kind == Kind::kSplit) {
    bool changed = false;
    for (int k = 0; k < 4; ++k)
      changed = balance(here.first_child + static_cast<std::uint32_t>(k), child(cell, k)) || changed;
    return changed;
  }
  if (here.kind != Kind::kLeaf || cell.size < 4) return false;
  const std::int32_t enough = cell.size / 4;
  const auto too_fine = [&](std::int32_t column, std::int32_t row, std::int32_t width, std::int32_t depth) {
    return finest(0, root_, {column, row, 0}, width, depth, enough) <= enough;
  };
  if (!too_fine(cell.column - 1, cell.row, 1, cell.size) &&
      !too_fine(cell.column + cell.size, cell.row, 1, cell.size) &&
      !too_fine(cell.column, cell.row - 1, cell.size, 1) && !too_fine(cell.column, cell.row + cell.size, cell.size, 1))
    return false;
  throw_if_cancelled();
  const std::uint32_t first = split(node);
  count_ -= 1.0;
  for (int k = 0; k < 4; ++k) {
    const bool none = outside(child(cell, k));
    nodes_[first + static_cast<std::uint32_t>(k)].kind = none ? Kind::kOutside : Kind::kLeaf;
    count_ += none ? 0.0 : 1.0;
  }
  return true;
}

void GroundPlan::balance() {
  while (count_ <= most_cells_ && balance(0, root_)) {
  }
}

template <class Visit>
void GroundPlan::visit(std::uint32_t node, const Cell& cell, const Visit& visit_cell) const {
  const Node& here = nodes_[node];
  if (here.kind == Kind::kLeaf) visit_cell(cell);
  if (here.kind == Kind::kSplit)
    for (int k = 0; k < 4; ++k) visit(here.first_child + static_cast<std::uint32_t>(k), child(cell, k), visit_cell);
  if (here.kind != Kind::kFull) return;
  for (std::int32_t r = cell.row; r < std::min(cell.row + cell.size, rows_); ++r)
    for (std::int32_t c = cell.column; c < std::min(cell.column + cell.size, columns_); ++c) visit_cell({c, r, 1});
}

std::vector<GroundPlan::Cell> GroundPlan::list() const {
  std::vector<Cell> out;
  out.reserve(static_cast<std::size_t>(count_));
  visit(0, root_, [&](const Cell& cell) { out.push_back(cell); });
  std::sort(out.begin(), out.end(),
            [](const Cell& a, const Cell& b) { return a.row != b.row ? a.row < b.row : a.column < b.column; });
  return out;
}

}  // namespace canyon::scene
