#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "scene/facet.h"

namespace canyon::scene {
namespace {

constexpr double kCell_m = 25.0;
constexpr int kMaxCells = 400;  // per side; larger scenes get larger cells

}  // namespace

FacetIndex::FacetIndex(std::vector<Facet> facets) : facets_(std::move(facets)) {
  if (facets_.empty()) return;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
  for (const Facet& f : facets_) {
    low = low.cwiseMin((f.center_W.array() - f.radius_m).matrix().head<2>());
    high = high.cwiseMax((f.center_W.array() + f.radius_m).matrix().head<2>());
  }
  CANYON_CHECK(low.allFinite() && high.allFinite(), "facets from ", low.transpose(), " to ", high.transpose());
  origin_ = low;
  cell_m_ = std::max(kCell_m, (high - low).maxCoeff() / kMaxCells);
  columns_ = static_cast<int>((high.x() - low.x()) / cell_m_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / cell_m_) + 1;
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t i = 0; i < facets_.size(); ++i) {
    const Cells range = cells_around(facets_[i].center_W, facets_[i].radius_m);
    for (int row = range.row0; row <= range.row1; ++row) {
      for (int column = range.column0; column <= range.column1; ++column) cells_[cell(column, row)].push_back(i);
    }
  }
}

FacetIndex::Cells FacetIndex::cells_around(const Eigen::Vector3d& p_W, double radius_m) const {
  const auto clamp_to = [&](double x, int count) {
    return static_cast<int>(std::clamp(std::floor(x / cell_m_), 0.0, static_cast<double>(count - 1)));
  };
  return {clamp_to(p_W.x() - radius_m - origin_.x(), columns_), clamp_to(p_W.x() + radius_m - origin_.x(), columns_),
          clamp_to(p_W.y() - radius_m - origin_.y(), rows_), clamp_to(p_W.y() + radius_m - origin_.y(), rows_)};
}

void FacetIndex::near(const Eigen::Vector3d& p_W, double radius_m, std::vector<std::uint32_t>& out) const {
  CANYON_CHECK(p_W.allFinite() && radius_m >= 0.0, "p = ", p_W.transpose(), ", radius_m = ", radius_m);
  out.clear();
  if (facets_.empty()) return;
  const Cells range = cells_around(p_W, radius_m);
  for (int row = range.row0; row <= range.row1; ++row) {
    for (int column = range.column0; column <= range.column1; ++column) {
      for (const std::uint32_t i : cells_[cell(column, row)]) {
        const Facet& f = facets_[i];
        // A facet that lies in several cells is taken in the first of them that is searched.
        const Cells own = cells_around(f.center_W, f.radius_m);
        if (column != std::max(own.column0, range.column0) || row != std::max(own.row0, range.row0)) continue;
        const double reach_m = radius_m + f.radius_m;
        if ((f.center_W - p_W).squaredNorm() <= reach_m * reach_m) out.push_back(i);
      }
    }
  }
  std::sort(out.begin(), out.end());
}

}  // namespace canyon::scene
