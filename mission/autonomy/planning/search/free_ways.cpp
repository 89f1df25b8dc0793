#include "canyon/mission/autonomy/planning/search/free_ways.h"

#include <algorithm>
#include <cmath>

namespace canyon::mission {

FreeWays::FreeWays(const PlanTask& task, const PlanParameters& p, const OffsetRange& range, const CostOfPlace& cost_1_m)
    : from_m_(task.s_m),
      right_m_(range.right_m),
      columns_(static_cast<std::size_t>(std::ceil(p.horizon_m / kCell_m)) + 1),
      rows_(static_cast<std::size_t>(std::ceil((range.left_m - range.right_m) / kCell_m)) + 1),
      cost_(columns_ * rows_, 0.0) {
  const LanePlaces lane(task);
  const KnownVehicle point{.rear_m = 0.0, .front_m = 0.0, .half_width_m = 0.0};
  // Less half a cell, so that no gap of the grid is closed that is open.
  const double reach_m = task.vehicle.half_width_m + p.clearance_m - 0.5 * kCell_m;
  std::vector<double> next_cost_1_m(rows_), here_cost_1_m(rows_);
  std::vector<bool> next_blocked(rows_);
  for (std::size_t i = columns_; i-- > 0;) {
    const double missing_m = std::max(0.0, p.horizon_m - kCell_m * static_cast<double>(i));
    for (std::size_t j = 0; j < rows_; ++j) {
      const LanePlaces::Place place{from_m_ + kCell_m * static_cast<double>(i),
                                    right_m_ + kCell_m * static_cast<double>(j)};
      here_cost_1_m[j] = cost_1_m(place);
      double best = p.blocked_cost_1_m * missing_m + p.horizon_m * here_cost_1_m[j];
      for (int aside = -kMostAside; aside <= kMostAside && i + 1 < columns_; ++aside) {
        const std::size_t to = j + static_cast<std::size_t>(aside);  // below the first: beyond the last
        if (to >= rows_ || next_blocked[to]) continue;
        best = std::min(best, 0.5 * kCell_m * (here_cost_1_m[j] + next_cost_1_m[to]) + at(i + 1, to));
      }
      at(i, j) = best;
    }
    for (std::size_t j = 0; j < rows_; ++j) {
      const PlanPose pose{
          lane.at({from_m_ + kCell_m * static_cast<double>(i), right_m_ + kCell_m * static_cast<double>(j)}), 0.0};
      next_blocked[j] = task.blocked.clearance_m(pose, point, reach_m) < reach_m;
    }
    std::swap(next_cost_1_m, here_cost_1_m);
  }
}

std::size_t FreeWays::row(double beside_m) const {
  const double j = std::round((beside_m - right_m_) / kCell_m);
  return static_cast<std::size_t>(std::clamp(j, 0.0, static_cast<double>(rows_ - 1)));
}

double FreeWays::cost(const LanePlaces::Place& place) const {
  const double i = std::round((place.s_m - from_m_) / kCell_m);
  const auto column = static_cast<std::size_t>(std::clamp(i, 0.0, static_cast<double>(columns_ - 1)));
  return cost_[column * rows_ + row(place.beside_m)];
}

}  // namespace canyon::mission
