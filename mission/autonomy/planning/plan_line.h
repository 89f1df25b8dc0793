#pragma once

#include <cstddef>
#include <vector>

#include "canyon/mission/autonomy/known_vehicle.h"

namespace canyon::mission {

/// A line in the local frame O that a tracker follows: points at about kSpacing_m, in the order of driving.
struct PlanLine {
  static constexpr double kSpacing_m = 0.25;
  std::vector<Eigen::Vector2d> points_O;

  bool empty() const { return points_O.size() < 2; }
  /// The point nearest to p from `from` on, as far as the line comes nearer; some way past the next ones.
  std::size_t nearest(const Eigen::Vector2d& p, std::size_t from) const;
  const Eigen::Vector2d& at(std::size_t i) const { return points_O[i < points_O.size() ? i : points_O.size() - 1]; }
  Eigen::Vector2d direction(std::size_t i) const;  ///< unit
};

}  // namespace canyon::mission
