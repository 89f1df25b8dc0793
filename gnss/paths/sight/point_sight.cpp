#include "canyon/gnss/paths/sight/point_sight.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kMostBytes = std::size_t{4} << 20;  // remembered of places, and of directions

/// 21 bits each: 2^20 cells to either side, 2000 km of places.
std::uint64_t lattice_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  return (static_cast<std::uint64_t>(x) & kMask) << 42 | (static_cast<std::uint64_t>(y) & kMask) << 21 |
         (static_cast<std::uint64_t>(z) & kMask);
}

/// Of a point of the plane of directions, its distance from the middle being the angle from the zenith.
Eigen::Vector3d direction_at(const Eigen::Vector2d& d_rad) {
  const double zenith_rad = d_rad.norm();
  if (zenith_rad == 0.0) return Eigen::Vector3d::UnitZ();
  const Eigen::Vector2d level = std::sin(zenith_rad) / zenith_rad * d_rad;
  return {level.x(), level.y(), std::cos(zenith_rad)};
}

}  // namespace

double PointSight::From::share(std::uint32_t id, const Eigen::Vector3d& q_W, GnssCounters& counters) const {
  double sum = 0.0;
  for (const Corner& corner : corners_) {
    if (corner.weight == 0.0) continue;
    const bool seen = corner.node->seen(id, counters, [&] {
      const Eigen::Vector3d way_W = q_W - corner.p_W;
      const double r_m = way_W.norm();
      return r_m < 1e-3 || scene_->blocked_towards(corner.p_W, way_W / r_m, r_m);
    });
    if (seen) sum += corner.weight;
  }
  return sum;
}

PointSight::From PointSight::from(const Eigen::Vector3d& p_W) {
  places_.make_room();
  const Eigen::Vector3d cell = (p_W / kCell_m).array().floor();
  const Eigen::Vector3d f = p_W / kCell_m - cell;
  From out;
  out.scene_ = &scene_;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d at = cell;
    double weight = 1.0;
    for (int k = 0; k < 3; ++k) {
      const bool upper = (corner >> k & 1U) != 0;
      at[k] += upper ? 1.0 : 0.0;
      weight *= upper ? f[k] : 1.0 - f[k];
    }
    const auto key = lattice_key(std::llround(at.x()), std::llround(at.y()), std::llround(at.z()));
    out.corners_[corner] = {at * kCell_m, weight, places_.at(key)};
  }
  return out;
}

PointSight::Towards PointSight::towards(const Eigen::Vector3d& s_W) {
  directions_.make_room();
  const double level = s_W.head<2>().norm(), zenith_rad = std::atan2(level, s_W.z());
  const Eigen::Vector2d d =
      level > 0.0 ? Eigen::Vector2d(zenith_rad / (level * kCell_rad) * s_W.head<2>()) : Eigen::Vector2d::Zero();
  const Eigen::Vector2d cell = d.array().floor(), f = d - cell;
  Towards out;
  out.scene_ = &scene_;
  for (unsigned corner = 0; corner < 4; ++corner) {
    const Eigen::Vector2d upper(corner & 1U ? 1.0 : 0.0, corner & 2U ? 1.0 : 0.0), at = cell + upper;
    const double weight = (corner & 1U ? f.x() : 1.0 - f.x()) * (corner & 2U ? f.y() : 1.0 - f.y());
    const auto key = lattice_key(std::llround(at.x()), std::llround(at.y()), 0);
    out.corners_[corner] = {direction_at(kCell_rad * at), weight, directions_.at(key)};
  }
  return out;
}

SightNode* PointSight::Nodes::at(std::uint64_t key) {
  SightNode& node = nodes_[key];
  largest_bytes_ = std::max(largest_bytes_, node.bytes());
  return &node;
}

void PointSight::Nodes::make_room() {
  if (nodes_.size() * largest_bytes_ <= kMostBytes) return;
  nodes_.clear();
  largest_bytes_ = 0;
}

SightPool::Loan SightPool::borrow(const scene::Scene& scene) {
  const std::scoped_lock lock(mutex_);
  if (scene_ != &scene) {
    idle_.clear();
    scene_ = &scene;
  }
  if (idle_.empty()) return Loan(*this, std::make_unique<PointSight>(scene));
  auto sight = std::move(idle_.back());
  idle_.pop_back();
  return Loan(*this, std::move(sight));
}

void SightPool::give_back(std::unique_ptr<PointSight> sight) {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(sight));
}

}  // namespace canyon::gnss
