#include "canyon/mission/autonomy/perception/blocked_cells.h"

#include <algorithm>
#include <cmath>

namespace canyon::mission {
namespace {

constexpr double kTile_m = 2.0;
constexpr int kTiles = static_cast<int>(2.0 * BlockedCells::kReach_m / kTile_m);

}  // namespace

int BlockedCells::tile(double from_centre_m) const {
  return static_cast<int>(std::floor((from_centre_m + kReach_m) / kTile_m));
}

BlockedCells::BlockedCells(const Eigen::Vector2d& centre_O, const std::vector<Eigen::Vector2d>& cells_O)
    : centre_(centre_O), first_(static_cast<std::size_t>(kTiles * kTiles + 1), 0U) {
  std::vector<std::size_t> of(cells_O.size());
  std::size_t kept = 0;
  constexpr std::size_t kNowhere = kTiles * kTiles;
  for (std::size_t i = 0; i < cells_O.size(); ++i) {
    const Eigen::Vector2d d = cells_O[i] - centre_;
    const int ix = tile(d.x()), iy = tile(d.y());
    const bool within = ix >= 0 && iy >= 0 && ix < kTiles && iy < kTiles;
    of[i] = within ? static_cast<std::size_t>(iy * kTiles + ix) : kNowhere;
    if (!within) continue;
    ++first_[of[i] + 1];
    ++kept;
  }
  for (std::size_t t = 1; t < first_.size(); ++t) first_[t] += first_[t - 1];
  cells_.resize(kept);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < cells_O.size(); ++i)
    if (of[i] != kNowhere) cells_[next[of[i]]++] = cells_O[i];
}

template <class Look>
void BlockedCells::look_around(const Eigen::Vector2d& from_centre, double reach_m, const Look& look) const {
  const int x0 = std::max(0, tile(from_centre.x() - reach_m)),
            x1 = std::min(kTiles - 1, tile(from_centre.x() + reach_m));
  const int y0 = std::max(0, tile(from_centre.y() - reach_m)),
            y1 = std::min(kTiles - 1, tile(from_centre.y() + reach_m));
  for (int iy = y0; iy <= y1 && x0 <= x1; ++iy) {
    // The tiles of a row lie one after the other.
    const auto row = static_cast<std::size_t>(iy * kTiles);
    look(first_[row + static_cast<std::size_t>(x0)], first_[row + static_cast<std::size_t>(x1) + 1]);
  }
}

double BlockedCells::clearance_m(const PlanPose& body, const KnownVehicle& vehicle, double cap_m) const {
  const Eigen::Vector2d u = body.forward();
  const double middle = 0.5 * (vehicle.rear_m + vehicle.front_m), half = 0.5 * (vehicle.front_m - vehicle.rear_m);
  const Eigen::Vector2d centre = body.p_m + middle * u - centre_;
  double best = cap_m * cap_m;
  look_around(centre, std::hypot(half, vehicle.half_width_m) + cap_m, [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i) {
      const Eigen::Vector2d d = cells_[i] - centre_ - centre;
      const double ahead = std::abs(u.dot(d)) - half;
      const double aside = std::abs(u.x() * d.y() - u.y() * d.x()) - vehicle.half_width_m;
      const double dx = std::max(0.0, ahead), dy = std::max(0.0, aside);
      best = std::min(best, dx * dx + dy * dy);
    }
  });
  return std::sqrt(best);
}

void BlockedCells::find_within(const Eigen::Vector2d& p_O, double distance_m, std::vector<std::uint32_t>& found) const {
  look_around(p_O - centre_, distance_m, [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i)
      if ((cells_[i] - p_O).norm() <= distance_m) found.push_back(i);
  });
}

}  // namespace canyon::mission
