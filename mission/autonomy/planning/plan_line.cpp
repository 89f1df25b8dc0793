#include "canyon/mission/autonomy/planning/plan_line.h"

#include <algorithm>

namespace canyon::mission {

std::size_t PlanLine::nearest(const Eigen::Vector2d& p, std::size_t from) const {
  constexpr std::size_t kAhead = 8;  // points without coming nearer
  std::size_t best = std::min(from, points_O.size() - 1);
  double nearest_m2 = (points_O[best] - p).squaredNorm();
  for (std::size_t i = best + 1; i < points_O.size() && i <= best + kAhead; ++i) {
    const double d = (points_O[i] - p).squaredNorm();
    if (d >= nearest_m2) continue;
    nearest_m2 = d;
    best = i;
  }
  return best;
}

Eigen::Vector2d PlanLine::direction(std::size_t i) const {
  const std::size_t last = points_O.size() - 1, a = std::min(i, last - 1);
  const Eigen::Vector2d d = points_O[a + 1] - points_O[a];
  return d.squaredNorm() > 0.0 ? Eigen::Vector2d(d.normalized()) : Eigen::Vector2d(1.0, 0.0);
}

}  // namespace canyon::mission
