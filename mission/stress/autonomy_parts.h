#pragma once

#include <cmath>

#include <Eigen/Core>

#include "canyon/core/stress_rows.h"

/// What the cases of an autonomy's parts share, each part by itself.
namespace canyon::mission {

/// Along and to the left of a heading.
inline Eigen::Vector2d seen_from(const Eigen::Vector2d& p, const Eigen::Vector2d& at, double yaw) {
  const Eigen::Vector2d d = p - at;
  return {d.x() * std::cos(yaw) + d.y() * std::sin(yaw), d.y() * std::cos(yaw) - d.x() * std::sin(yaw)};
}

inline StressMechanism autonomy_part() {
  return {.group = StressGroup::kGeometry,
          .mechanism = "an autonomy's parts by themselves, turned, moved and at their limits",
          .why =
              "a body of the other end, a side exchanged, a cost or a limit of the wrong size, and the whole still "
              "drives",
          .expected = "formulas and searches through everything, written out: roundings",
          .unit = "of the bound",
          .loose = "some bounds are those of the farthest of many places"};
}

}  // namespace canyon::mission
