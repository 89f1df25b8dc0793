#pragma once

#include <vector>

#include "canyon/mission/autonomy/reference.h"

namespace canyon::mission::testing {

/// The reference autonomy as it is without a key set.
inline const ReferenceParameters& defaults() {
  static const ReferenceParameters kept;
  return kept;
}

inline std::unique_ptr<Tracker> default_tracker(const char* name) {
  return model_row(trackers(), name).make(defaults().tracker.model.own, KnownVehicle{});
}

inline std::unique_ptr<LocalPlanner> default_planner(const char* name) {
  return model_row(local_planners(), name).make(defaults().planner.model.own);
}

/// Cells of a wall from one place to another.
inline void add_wall(std::vector<Eigen::Vector2d>& cells, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double length = (to - from).norm();
  for (double x = 0.0; x <= length; x += 0.2) cells.emplace_back(from + x / length * (to - from));
}

}  // namespace canyon::mission::testing
