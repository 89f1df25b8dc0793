#include "canyon/scene/surfaces/foliage_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "canyon/core/process/progress.h"

namespace canyon::scene {
namespace {

constexpr double kCrownCell_m = 10.0;
constexpr int kMostCrownCells = 1000;  // per side; larger scenes get larger cells

/// Where the ray enters and leaves the crown; leaves no later than it enters if it does not meet it.
std::pair<double, double> chord(const Foliage& crown, const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W,
                                double max_m) {
  // In the frame where the crown is a unit sphere: |o + s d|^2 = 1.
  const Eigen::Vector3d o = (p_W - crown.center_W).cwiseQuotient(crown.radii_m);
  const Eigen::Vector3d d = direction_W.cwiseQuotient(crown.radii_m);
  const double dd = d.squaredNorm(), od = o.dot(d);
  const double discriminant = od * od - dd * (o.squaredNorm() - 1.0);
  if (discriminant <= 0.0) return {0.0, 0.0};
  const double root = std::sqrt(discriminant);
  const double enter_m = std::max((-od - root) / dd, 0.0);
  const double leave_m = std::min((-od + root) / dd, max_m);
  return {enter_m, leave_m};
}

/// (-a, -b, 1) of the plane z = a x + b y + c that fits the crowns' centers; level if they do not tell.
Eigen::Vector3d slope_of(const std::vector<Foliage>& crowns) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Foliage& c : crowns) mean += c.center_W;
  mean /= static_cast<double>(crowns.size());
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0;
  for (const Foliage& c : crowns) {
    const Eigen::Vector3d d = c.center_W - mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y(), xz += d.x() * d.z(), yz += d.y() * d.z();
  }
  const double det = xx * yy - xy * xy;
  if (!(det > 1e-6 * (xx + yy) * (xx + yy))) return Eigen::Vector3d::UnitZ();
  return {-(xz * yy - yz * xy) / det, -(yz * xx - xz * xy) / det, 1.0};
}

}  // namespace

FoliageIndex::FoliageIndex(const std::vector<Foliage>& crowns) : crowns_(crowns) {
  if (crowns_.empty()) return;
  low_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  for (const Foliage& c : crowns_) {
    low_ = low_.cwiseMin(c.center_W - c.radii_m);
    high_ = high_.cwiseMax(c.center_W + c.radii_m);
  }
  slope_ = slope_of(crowns_);
  floor_m_ = std::numeric_limits<double>::infinity();
  ceiling_m_ = -floor_m_;
  for (const Foliage& c : crowns_) {
    const double middle_m = slope_.dot(c.center_W), half_m = slope_.cwiseProduct(c.radii_m).norm();
    floor_m_ = std::min(floor_m_, middle_m - half_m);
    ceiling_m_ = std::max(ceiling_m_, middle_m + half_m);
  }
  const Eigen::Vector3d size = high_ - low_;
  cell_m_ = std::max(kCrownCell_m, std::max(size.x(), size.y()) / kMostCrownCells);
  per_m_ = 1.0 / cell_m_;
  columns_ = static_cast<int>(size.x() / cell_m_) + 1;
  rows_ = static_cast<int>(size.y() / cell_m_) + 1;
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t i = 0; i < crowns_.size(); ++i) {
    throw_if_cancelled();
    const Foliage& c = crowns_[i];
    const auto cell_of = [&](double x, double origin, int count) {
      return std::clamp(static_cast<int>((x - origin) / cell_m_), 0, count - 1);
    };
    for (int row = cell_of(c.center_W.y() - c.radii_m.y(), low_.y(), rows_);
         row <= cell_of(c.center_W.y() + c.radii_m.y(), low_.y(), rows_); ++row) {
      for (int column = cell_of(c.center_W.x() - c.radii_m.x(), low_.x(), columns_);
           column <= cell_of(c.center_W.x() + c.radii_m.x(), low_.x(), columns_); ++column) {
        Cell& cell = cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                            static_cast<std::size_t>(column)];
        cell.bottom_m = std::min(cell.bottom_m, c.center_W.z() - c.radii_m.z());
        cell.top_m = std::max(cell.top_m, c.center_W.z() + c.radii_m.z());
        cell.crowns.push_back(i);
      }
    }
  }
}

void FoliageIndex::add_cell(const Cell& cell, const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W,
                            double enter_m, double leave_m, std::vector<std::uint32_t>& met) const {
  if (cell.crowns.empty()) return;
  const double z0 = p_W.z() + enter_m * direction_W.z(), z1 = p_W.z() + leave_m * direction_W.z();
  if (std::min(z0, z1) > cell.top_m || std::max(z0, z1) < cell.bottom_m) return;
  for (const std::uint32_t i : cell.crowns) {
    const Foliage& c = crowns_[i];
    // The bounding sphere turns most crowns away cheaply.
    const Eigen::Vector3d to_center = c.center_W - p_W;
    const double along_m = to_center.dot(direction_W), radius_m = c.radii_m.maxCoeff();
    if (to_center.squaredNorm() - along_m * along_m <= radius_m * radius_m) met.push_back(i);
  }
}

void FoliageIndex::find(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m,
                        std::vector<std::uint32_t>& met) const {
  if (cells_.empty()) return;
  // The part of the ray inside the layer of crowns, and inside the rectangle around them.
  double begin_m = 0.0, end_m = max_m;
  const auto clip = [&](double at, double inverse_speed, double low, double high) {
    if (!std::isfinite(inverse_speed)) {
      if (at < low || at > high) end_m = -1.0;
      return;
    }
    const double in = (low - at) * inverse_speed, out = (high - at) * inverse_speed;
    begin_m = std::max(begin_m, std::min(in, out));
    end_m = std::min(end_m, std::max(in, out));
  };
  const double slow_x = 1.0 / direction_W.x(), slow_y = 1.0 / direction_W.y();
  clip(slope_.dot(p_W), 1.0 / slope_.dot(direction_W), floor_m_, ceiling_m_);
  clip(p_W.x(), slow_x, low_.x(), high_.x());
  clip(p_W.y(), slow_y, low_.y(), high_.y());
  if (!(begin_m <= end_m)) return;

  // From cell to cell of the grid (Amanatides & Woo 1987).
  const Eigen::Vector2d origin = low_.head<2>(), d = direction_W.head<2>();
  const Eigen::Vector2d start = p_W.head<2>() + begin_m * d - origin;
  int column = std::clamp(static_cast<int>(start.x() * per_m_), 0, columns_ - 1);
  int row = std::clamp(static_cast<int>(start.y() * per_m_), 0, rows_ - 1);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const int step_x = d.x() > 0.0 ? 1 : -1, step_y = d.y() > 0.0 ? 1 : -1;
  const auto border = [&](int cell, int step, double from, double inverse_speed) {
    if (!std::isfinite(inverse_speed)) return kNever;
    return begin_m + ((cell + (step > 0 ? 1 : 0)) * cell_m_ - from) * inverse_speed;
  };
  double next_x = border(column, step_x, start.x(), slow_x), next_y = border(row, step_y, start.y(), slow_y);
  const double width_x = cell_m_ * std::abs(slow_x), width_y = cell_m_ * std::abs(slow_y);
  double at_m = begin_m;
  while (column >= 0 && column < columns_ && row >= 0 && row < rows_ && at_m <= end_m) {
    const double leave_m = std::min({next_x, next_y, end_m});
    add_cell(
        cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)],
        p_W, direction_W, at_m, leave_m, met);
    at_m = std::min(next_x, next_y);
    if (next_x < next_y) {
      column += step_x;
      next_x += width_x;
    } else {
      row += step_y;
      next_y += width_y;
    }
  }
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
}

double FoliageIndex::chords_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m) const {
  std::vector<std::uint32_t> met;
  find(p_W, direction_W, max_m, met);
  double sum_m = 0.0;
  for (const std::uint32_t i : met) {
    const auto [enter_m, leave_m] = chord(crowns_[i], p_W, direction_W, max_m);
    const double weight = crowns_[i].leaf_density_m2_m3 / Foliage::kReferenceLeafDensity;
    sum_m += weight * std::max(leave_m - enter_m, 0.0);
  }
  return sum_m;
}

void FoliageIndex::passages(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m,
                            std::vector<CrownPassage>& out) const {
  out.clear();
  thread_local std::vector<std::uint32_t> met;
  met.clear();
  find(p_W, direction_W, max_m, met);
  for (const std::uint32_t i : met) {
    const auto [enter_m, leave_m] = chord(crowns_[i], p_W, direction_W, max_m);
    if (leave_m > enter_m) out.push_back({enter_m, leave_m, crowns_[i].leaf_density_m2_m3, i});
  }
}

}  // namespace canyon::scene
