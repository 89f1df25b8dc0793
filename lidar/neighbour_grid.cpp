#include "lidar/neighbour_grid.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace canyon::lidar {

NeighbourGrid::NeighbourGrid(std::span<const Eigen::Vector3f> points, double cell_m)
    : cells_(cell_m, points.size() / 2) {
  std::vector<std::uint32_t> cell(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) cell[i] = cells_.insert(cells_.coordinates(points[i]));
  begin_.assign(cells_.size() + 1, 0);
  for (std::uint32_t c : cell) ++begin_[c + 1];
  for (std::size_t c = 0; c < cells_.size(); ++c) begin_[c + 1] += begin_[c];
  entries_.resize(points.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    entries_[next[cell[i]]++] = {points[i].x(), points[i].y(), points[i].z(), static_cast<std::uint32_t>(i)};
  }
}

void NeighbourGrid::nearest(const Eigen::Vector3f& query, std::size_t k, double radius_m,
                            std::vector<Neighbour>& out) const {
  CANYON_CHECK(k > 0 && query.allFinite(), "k = ", k, ", query ", query.transpose());
  out.clear();
  float limit = static_cast<float>(radius_m * radius_m);
  const auto cell_m = static_cast<float>(cells_.leaf_m());
  const auto visit_cell = [&](const VoxelCoordinates& v) {
    // Squared distance from the query to the cell.
    float squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = static_cast<float>(v[axis]) * cell_m;
      const float outside = std::max({low - query[axis], query[axis] - (low + cell_m), 0.0f});
      squared += outside * outside;
    }
    if (squared > limit) return;
    const std::uint32_t number = cells_.find(v);
    if (number == VoxelIndex::kNone) return;
    for (std::uint32_t e = begin_[number]; e < begin_[number + 1]; ++e) {
      const Entry& entry = entries_[e];
      const float dx = entry.x - query.x();
      const float dy = entry.y - query.y();
      const float dz = entry.z - query.z();
      const Neighbour found{dx * dx + dy * dy + dz * dz, entry.index};
      if (found.squared_m > limit || (out.size() == k && !(found < out.back()))) continue;
      if (out.size() == k) out.pop_back();
      out.insert(std::upper_bound(out.begin(), out.end(), found), found);
      if (out.size() == k) limit = out.back().squared_m;
    }
  };
  // Starts with the eight cells around the query and grows by one layer of cells at a time.
  const VoxelCoordinates low = cells_.coordinates((query.array() - 0.5f * cell_m).matrix());
  const Eigen::Vector3f within = query - low.cast<float>() * cell_m;  // in [cell/2, 3 cell/2)
  const float first_reach = std::min(within.minCoeff(), 2.0f * cell_m - within.maxCoeff());
  for (int layer = 0;; ++layer) {
    const int from = -layer;
    const int to = 1 + layer;
    for (int i = from; i <= to; ++i) {
      for (int j = from; j <= to; ++j) {
        const bool face = i == from || i == to || j == from || j == to;
        for (int l = from; l <= to; l += face || layer == 0 ? 1 : to - from)
          visit_cell(low + VoxelCoordinates(i, j, l));
      }
    }
    const float reach = first_reach + static_cast<float>(layer) * cell_m;
    if (reach > 0 && reach * reach >= limit) break;
  }
  while (!out.empty() && !(out.back().squared_m < static_cast<float>(radius_m * radius_m))) out.pop_back();
}

}  // namespace canyon::lidar
