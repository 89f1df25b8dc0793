#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "canyon/mission/autonomy/planning/plan_parameters.h"
#include "canyon/mission/autonomy/planning/search/lane_places.h"

namespace canyon::mission {

/// What a way costs per metre where it is, besides what turning and closeness cost. Where it ends it costs as much as a
/// whole horizon there.
using CostOfPlace = std::function<double(const LanePlaces::Place&)>;

/// The cheapest ways on of a point as wide as the vehicle, which may turn on the spot by up to 63 degrees to either
/// side of the route, from every place of a grid along the lane to the horizon, or to where they end: a metre that is
/// missing to the horizon costs `blocked_cost_1_m`. What such a way costs is nearly the least that the vehicle's own
/// may, so a search is led by it (the heuristic "holonomic with obstacles" of Dolgov et al. 2010).
class FreeWays {
 public:
  FreeWays(const PlanTask& task, const PlanParameters& p, const OffsetRange& range, const CostOfPlace& cost_1_m);

  /// From the place of the grid that is nearest on.
  double cost(const LanePlaces::Place& place) const;

 private:
  static constexpr double kCell_m = 0.5;
  static constexpr int kMostAside = 2;  // cells, in one of the way

  std::size_t row(double beside_m) const;
  double& at(std::size_t column, std::size_t row) { return cost_[column * rows_ + row]; }

  double from_m_, right_m_;
  std::size_t columns_, rows_;
  std::vector<double> cost_;
};

}  // namespace canyon::mission
