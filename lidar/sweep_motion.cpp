#include "lidar/sweep_motion.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace canyon::lidar {
namespace {

constexpr double kNodeSpacing_s = 0.25e-3;
constexpr double kTimeTolerance_s = 1e-8;  // a point's time_s in single precision: 4 ns at 0.1 s

}  // namespace

SweepMotion::SweepMotion(const Trajectory& motion, GpsTime stamp, double first_s, double last_s, const Pose& X_RW,
                         const Pose& X_BL) {
  const auto& poses = motion.poses();
  if (poses.empty()) return;
  const auto add = [&](double time_s, const Pose& X_WB) {
    const Pose X_RL = X_RW * X_WB * X_BL;
    nodes_.push_back({time_s, {X_RL.R.toRotationMatrix(), X_RL.p}});
  };
  const double begin_s = std::max(first_s, poses.front().t - stamp);
  const double end_s = std::min(last_s, poses.back().t - stamp);
  if (poses.size() == 1 || begin_s >= end_s) {
    if (begin_s <= end_s + kTimeTolerance_s)
      add(begin_s, motion.at(std::clamp(stamp + begin_s, poses.front().t, poses.back().t)).value());
    return;
  }
  // The last pose at or before begin.
  auto knot = std::upper_bound(poses.begin(), poses.end(), begin_s,
                               [&](double time_s, const StampedPose& pose) { return time_s < pose.t - stamp; });
  if (knot != poses.begin()) --knot;
  for (; std::next(knot) != poses.end() && knot->t - stamp < end_s; ++knot) {
    const StampedPose& a = *knot;
    const StampedPose& b = *std::next(knot);
    const double a_s = a.t - stamp;
    const double b_s = b.t - stamp;
    const double from_s = std::max(a_s, begin_s);
    const double to_s = std::min(b_s, end_s);
    const int pieces = std::max(1, static_cast<int>(std::ceil((to_s - from_s) / kNodeSpacing_s - 1e-6)));
    for (int i = 0; i < pieces; ++i) {
      const double time_s = from_s + (to_s - from_s) * i / pieces;
      if (!nodes_.empty() && time_s <= nodes_.back().time_s) continue;
      add(time_s, interpolate(a.X_WB, b.X_WB, (time_s - a_s) / (b_s - a_s)));
    }
    if (to_s >= end_s) add(end_s, interpolate(a.X_WB, b.X_WB, (end_s - a_s) / (b_s - a_s)));
  }
}

bool SweepMotion::covers(double time_s) const {
  return !nodes_.empty() && time_s >= nodes_.front().time_s - kTimeTolerance_s &&
         time_s <= nodes_.back().time_s + kTimeTolerance_s;
}

SweepMotion::Placement SweepMotion::at(double time_s, std::size_t& hint) const {
  CANYON_CHECK(covers(time_s), "time_s = ", time_s);
  if (nodes_.size() == 1) return nodes_.front().placement;
  if (hint + 1 >= nodes_.size() || time_s < nodes_[hint].time_s) {
    const auto next = std::upper_bound(nodes_.begin(), nodes_.end(), time_s,
                                       [](double t, const Node& node) { return t < node.time_s; });
    const auto index = next - nodes_.begin() - 1;
    hint = std::min<std::size_t>(index < 0 ? 0 : static_cast<std::size_t>(index), nodes_.size() - 2);
  }
  while (hint + 2 < nodes_.size() && time_s >= nodes_[hint + 1].time_s) ++hint;
  const Node& a = nodes_[hint];
  const Node& b = nodes_[hint + 1];
  const double s = (time_s - a.time_s) / (b.time_s - a.time_s);
  return {a.placement.R + s * (b.placement.R - a.placement.R), a.placement.p + s * (b.placement.p - a.placement.p)};
}

}  // namespace canyon::lidar
