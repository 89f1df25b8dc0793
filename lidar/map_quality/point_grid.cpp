#include "canyon/lidar/map_quality/point_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "canyon/core/check.h"

namespace canyon::lidar {

std::size_t PointGrid::Hash::operator()(const Cell& c) const {
  std::uint64_t hash = 14695981039346656037u;
  for (const std::int64_t v : {c.x, c.y, c.z}) hash = (hash ^ static_cast<std::uint64_t>(v)) * 1099511628211u;
  return static_cast<std::size_t>(hash ^ (hash >> 29));
}

PointGrid::Cell PointGrid::cell_of(const Eigen::Vector3d& p) const {
  const auto along = [this](double v) { return static_cast<std::int64_t>(std::floor(v / cell_m_)); };
  return {along(p.x()), along(p.y()), along(p.z())};
}

PointGrid::PointGrid(std::span<const Eigen::Vector3f> points, double cell_m)
    : cell_m_(cell_m), points_(points.begin(), points.end()), order_(points.size()) {
  CANYON_CHECK(cell_m > 0 && points.size() < 0xffffffffu, "cell_m = ", cell_m, ", ", points.size(), " points");
  std::vector<Cell> cells;
  cells.reserve(points_.size());
  for (const Eigen::Vector3f& p : points_) {
    CANYON_CHECK(p.allFinite(), "point ", p.transpose());
    cells.push_back(cell_of(p.cast<double>()));
  }
  std::iota(order_.begin(), order_.end(), 0u);
  const auto key = [&cells](std::uint32_t i) { return std::tuple(cells[i].x, cells[i].y, cells[i].z, i); };
  std::sort(order_.begin(), order_.end(), [&key](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::uint32_t begin = 0; begin < order_.size();) {
    std::uint32_t end = begin + 1;
    while (end < order_.size() && cells[order_[end]] == cells[order_[begin]]) ++end;
    cells_[cells[order_[begin]]] = {begin, end};
    begin = end;
  }
}

template <class Visit>
void PointGrid::visit_ball(const Eigen::Vector3d& p, double reach_m, const Visit& visit) const {
  const Cell low = cell_of(p.array() - reach_m), high = cell_of(p.array() + reach_m);
  for (std::int64_t x = low.x; x <= high.x; ++x)
    for (std::int64_t y = low.y; y <= high.y; ++y)
      for (std::int64_t z = low.z; z <= high.z; ++z) {
        const auto found = cells_.find({x, y, z});
        if (found == cells_.end()) continue;
        for (std::uint32_t k = found->second.begin; k < found->second.end; ++k) visit(order_[k]);
      }
}

double PointGrid::nearest_m(const Eigen::Vector3d& p, double reach_m) const {
  double best2 = reach_m * reach_m;
  // The near cells first: what is found there leaves little to look at.
  for (double reach = std::min(0.5 * cell_m_, reach_m);; reach = std::min(2.0 * reach, reach_m)) {
    visit_ball(p, reach,
               [&](std::uint32_t i) { best2 = std::min(best2, (points_[i].cast<double>() - p).squaredNorm()); });
    if (best2 <= reach * reach || reach >= reach_m) break;
  }
  return std::sqrt(best2);
}

void PointGrid::within(const Eigen::Vector3d& p, double reach_m, std::vector<std::uint32_t>& out) const {
  out.clear();
  const double reach2 = reach_m * reach_m;
  visit_ball(p, reach_m, [&](std::uint32_t i) {
    if ((points_[i].cast<double>() - p).squaredNorm() <= reach2) out.push_back(i);
  });
  std::sort(out.begin(), out.end());
}

}  // namespace canyon::lidar
