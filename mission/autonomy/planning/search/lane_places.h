#pragma once

#include <Eigen/Core>

#include "canyon/mission/autonomy/planning/local_planner.h"

namespace canyon::mission {

/// Places along a task's lane: how far along the route, and how far beside the lane's middle (left positive). After the
/// route's end it goes straight on.
class LanePlaces {
 public:
  explicit LanePlaces(const PlanTask& task) : task_(task) {}

  struct Place {
    double s_m, beside_m;
  };
  /// Of a place in O whose nearest one on the route lies between two.
  Place of(const Eigen::Vector2d& p_O, double from_m, double to_m) const;
  Eigen::Vector2d at(const Place& place) const;  ///< in O

 private:
  const PlanTask& task_;
};

}  // namespace canyon::mission
