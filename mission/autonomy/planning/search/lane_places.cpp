#include "canyon/mission/autonomy/planning/search/lane_places.h"

#include <algorithm>

namespace canyon::mission {

LanePlaces::Place LanePlaces::of(const Eigen::Vector2d& p_O, double from_m, double to_m) const {
  const Eigen::Vector2d p_W = p_O + task_.from_O_to_W;
  const double end_m = task_.route.length_m();
  double s = task_.route.project(p_W, std::min(from_m, end_m), to_m);
  if (s >= end_m) s += std::max(0.0, task_.route.direction(end_m).dot(p_W - task_.route.at(end_m)));
  return {s, task_.route.offset(p_W, s) - task_.lane_m};
}

Eigen::Vector2d LanePlaces::at(const Place& place) const {
  const Eigen::Vector2d u = task_.route.direction(place.s_m);
  return task_.route.at(place.s_m) + std::max(0.0, place.s_m - task_.route.length_m()) * u +
         (task_.lane_m + place.beside_m) * Eigen::Vector2d(-u.y(), u.x()) - task_.from_O_to_W;
}

}  // namespace canyon::mission
