#include "canyon/lidar/deskew.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel_keep.h"
#include "canyon/lidar/sweep_motion.h"
#include "canyon/lidar/turned.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kChunk = 4096;  // returns

bool is_finite(const LidarPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

std::vector<std::string> deskewing_names() {
  return {"prediction", "estimate", "none", "truth"};
}

Deskewing deskewing(std::string_view name) {
  const auto names = deskewing_names();
  const auto at = std::find(names.begin(), names.end(), name);
  CANYON_CHECK(at != names.end(), "no deskewing \"", name, "\"");
  return static_cast<Deskewing>(at - names.begin());
}

LidarScan deskew(const LidarScan& scan, const Trajectory& motion, const Pose& X_BL) {
  LidarScan out{.t = scan.t, .period_s = scan.period_s, .points = {}};
  const auto X_WB = motion.at(scan.t);
  if (!X_WB) return out;
  const Pose X_LW = (*X_WB * X_BL).inverse();
  // Lasers that run free may begin their first cycle a little before the period.
  const double first_s = scan.points.empty() ? 0.0 : double{scan.points.front().time_s};
  const SweepMotion sweep(motion, scan.t, std::min(-scan.period_s, first_s), 0.0, X_LW, X_BL);
  parallel_keep(scan.points.size(), kChunk, out.points, [&](std::size_t begin, std::size_t end, LidarPoint* moved) {
    SweepMotion::Reader reader(sweep);
    for (std::size_t k = begin; k < end; ++k) {
      const LidarPoint& point = scan.points[k];
      if (!sweep.covers(point.time_s) || !is_finite(point)) continue;
      const SweepMotion::Placement X = reader.at(point.time_s);
      const Eigen::Vector3d p = turned(X.R, Eigen::Vector3d(point.x, point.y, point.z)) + X.p;
      *moved = point;
      moved->x = static_cast<float>(p.x());
      moved->y = static_cast<float>(p.y());
      moved->z = static_cast<float>(p.z());
      moved->time_s = 0;
      ++moved;
    }
    return moved;
  });
  return out;
}

LidarScan not_deskewed(const LidarScan& scan) {
  LidarScan out{.t = scan.t, .period_s = scan.period_s, .points = {}};
  out.points.reserve(scan.points.size());
  for (LidarPoint point : scan.points) {
    if (!is_finite(point)) continue;
    point.time_s = 0;
    out.points.push_back(point);
  }
  return out;
}

}  // namespace canyon::lidar
