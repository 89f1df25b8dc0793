#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::mission::testing {

inline constexpr double kMast_m = 1.8;

/// A box that stands on the ground, along the world's axes; its lower corner and its upper one over the ground below
/// each point, so that on a slope its top leans as the ground does.
struct Box {
  Eigen::Vector3d low, high;
};

/// What sixteen beams from -15 to 15 degrees see from `p`, 1.8 m over ground that rises by `slope` along x; ranges with
/// white noise of `noise_m`.
inline LidarScan box_scan(const Eigen::Vector2d& p, const std::vector<Box>& boxes, GpsTime t, double slope = 0.0,
                          double noise_m = 0.0, std::uint64_t seed = 0) {
  const RandomStream noise(seed, "tests.box_scan");
  LidarScan scan;
  scan.t = t;
  const Eigen::Vector3d from(p.x(), p.y(), kMast_m);  // heights over the ground below
  for (int ring = 0; ring < 16; ++ring) {
    const double elevation = (2 * ring - 15) * kDegree;
    for (int step = 0; step < 900; ++step) {
      const double azimuth = step * 0.4 * kDegree;
      const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
      const Eigen::Vector3d over(d.x(), d.y(), d.z() - slope * d.x());
      double nearest = 80.0;
      if (over.z() < 0.0) nearest = std::min(nearest, kMast_m / -over.z());
      for (const Box& box : boxes) {
        double enter = 0.0, leave = 80.0;
        for (int axis = 0; axis < 3; ++axis) {
          const double a = (box.low[axis] - from[axis]) / over[axis], b = (box.high[axis] - from[axis]) / over[axis];
          enter = std::max(enter, std::min(a, b));
          leave = std::min(leave, std::max(a, b));
        }
        if (enter < leave) nearest = std::min(nearest, enter);
      }
      if (nearest >= 80.0) continue;
      if (noise_m > 0.0)
        nearest += noise_m * noise.normal(static_cast<std::uint32_t>(ring), static_cast<std::uint64_t>(step));
      const Eigen::Vector3f q = (nearest * d).cast<float>();
      scan.points.push_back({q.x(), q.y(), q.z(), 0.3F, 0.0F, static_cast<std::uint16_t>(ring), 0});
    }
  }
  return scan;
}

}  // namespace canyon::mission::testing
