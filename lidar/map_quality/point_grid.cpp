#include "canyon/lidar/map_quality/point_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/check.h"

namespace canyon::lidar {
namespace {

constexpr std::int64_t kHalfOfCells = 1 << 20;
constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

template <class Coordinates>
std::uint64_t cell_key(const Coordinates& c) {
  const auto part = [](std::int64_t i) { return static_cast<std::uint64_t>(i + kHalfOfCells); };
  return part(c.x()) << 42 | part(c.y()) << 21 | part(c.z());
}

/// splitmix64's finalizer (Steele, Lea and Flood 2014).
std::size_t mixed(std::uint64_t key) {
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
  return static_cast<std::size_t>(key ^ (key >> 31));
}

}  // namespace

PointGrid::Coordinates PointGrid::coordinates_of(const Eigen::Vector3d& p) const {
  const auto along = [this](double v) {
    constexpr auto kMost = static_cast<double>(kHalfOfCells - 1);
    return static_cast<std::int64_t>(std::clamp(std::floor(v / cell_m_), -kMost, kMost));
  };
  return {along(p.x()), along(p.y()), along(p.z())};
}

PointGrid::PointGrid(std::span<const Eigen::Vector3f> points, double cell_m)
    : cell_m_(cell_m), points_(points.begin(), points.end()) {
  CANYON_CHECK(cell_m > 0 && points.size() < 0xffffffffu, "cell_m = ", cell_m, ", ", points.size(), " points");
  std::vector<std::pair<Key, std::uint32_t>> keys;
  keys.reserve(points_.size());
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    CANYON_CHECK(points_[i].allFinite(), "point ", points_[i].transpose());
    keys.emplace_back(cell_key(coordinates_of(points_[i].cast<double>())), i);
  }
  std::sort(keys.begin(), keys.end());
  order_.reserve(keys.size());
  ordered_.reserve(keys.size());
  for (const auto& [key, index] : keys) {
    const auto place = static_cast<std::uint32_t>(order_.size());
    if (cells_.empty() || cells_.back().key != key) cells_.push_back({key, place, place});
    ++cells_.back().end;
    order_.push_back(index);
    ordered_.push_back(points_[index]);
  }
  std::size_t slots = 16;
  while (slots < 2 * cells_.size()) slots *= 2;
  slots_.assign(slots, kNoCell);
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    std::size_t at = mixed(cells_[c].key) & (slots - 1);
    while (slots_[at] != kNoCell) at = (at + 1) & (slots - 1);
    slots_[at] = c;
  }
}

const PointGrid::Cell* PointGrid::find(const Coordinates& at) const {
  const Key key = cell_key(at);
  for (std::size_t slot = mixed(key) & (slots_.size() - 1); slots_[slot] != kNoCell;
       slot = (slot + 1) & (slots_.size() - 1))
    if (cells_[slots_[slot]].key == key) return &cells_[slots_[slot]];
  return nullptr;
}

template <class Visit>
void PointGrid::visit_ball(const Eigen::Vector3d& p, double reach_m, const Visit& visit) const {
  const Coordinates low = coordinates_of(p.array() - reach_m), high = coordinates_of(p.array() + reach_m);
  for (std::int64_t x = low.x(); x <= high.x(); ++x)
    for (std::int64_t y = low.y(); y <= high.y(); ++y)
      for (std::int64_t z = low.z(); z <= high.z(); ++z)
        if (const Cell* cell = find({x, y, z}))
          for (std::uint32_t k = cell->begin; k < cell->end; ++k)
            if (visit(k)) return;
}

double PointGrid::nearest_m(const Eigen::Vector3d& p, double reach_m) const {
  double best2 = reach_m * reach_m;
  // The near cells first: what is found there leaves little to look at.
  for (double reach = std::min(0.5 * cell_m_, reach_m);; reach = std::min(2.0 * reach, reach_m)) {
    visit_ball(p, reach, [&](std::uint32_t k) {
      best2 = std::min(best2, (ordered_[k].cast<double>() - p).squaredNorm());
      return false;
    });
    if (best2 <= reach * reach || reach >= reach_m) break;
  }
  return std::sqrt(best2);
}

void PointGrid::within(const Eigen::Vector3d& p, double reach_m, std::vector<std::uint32_t>& out) const {
  out.clear();
  const double reach2 = reach_m * reach_m;
  visit_ball(p, reach_m, [&](std::uint32_t k) {
    if ((ordered_[k].cast<double>() - p).squaredNorm() <= reach2) out.push_back(order_[k]);
    return false;
  });
  std::sort(out.begin(), out.end());
}

bool PointGrid::comes_within(const Eigen::Vector3d& p, double reach_m) const {
  bool found = false;
  visit_ball(p, reach_m, [&](std::uint32_t k) {
    return found = (ordered_[k].cast<double>() - p).squaredNorm() < reach_m * reach_m;
  });
  return found;
}

std::span<const Eigen::Vector3f> PointGrid::points_of(std::size_t cell) const {
  const Cell& c = cells_[cell];
  return std::span(ordered_).subspan(c.begin, c.end - c.begin);
}

std::vector<std::span<const Eigen::Vector3f>> PointGrid::around(std::size_t cell) const {
  std::vector<std::span<const Eigen::Vector3f>> out;
  const Coordinates middle = coordinates_of(ordered_[cells_[cell].begin].cast<double>());
  constexpr std::int64_t kLast = kHalfOfCells - 1;
  const Coordinates low = (middle.array() - 1).max(-kLast), high = (middle.array() + 1).min(kLast);
  for (std::int64_t x = low.x(); x <= high.x(); ++x)
    for (std::int64_t y = low.y(); y <= high.y(); ++y)
      for (std::int64_t z = low.z(); z <= high.z(); ++z)
        if (const Cell* near = find({x, y, z}))
          out.push_back(points_of(static_cast<std::size_t>(near - cells_.data())));
  return out;
}

}  // namespace canyon::lidar
