#include "canyon/core/motion/trajectory.h"

#include <algorithm>

#include "canyon/core/check.h"

namespace canyon {

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    CANYON_CHECK(poses_[i - 1].t < poses_[i].t, "pose ", i, " at ", poses_[i].t.ns, " ns after ", poses_[i - 1].t.ns,
                 " ns");
  }
}

void Trajectory::append(const StampedPose& pose) {
  CANYON_CHECK(poses_.empty() || poses_.back().t < pose.t, pose.t.ns, " ns after ", poses_.back().t.ns, " ns");
  poses_.push_back(pose);
}

namespace {

/// First pose later than t.
std::vector<StampedPose>::const_iterator after(const std::vector<StampedPose>& poses, GpsTime t) {
  return std::upper_bound(poses.begin(), poses.end(), t,
                          [](GpsTime value, const StampedPose& pose) { return value < pose.t; });
}

}  // namespace

void Trajectory::forget_before(GpsTime t) {
  const auto next = after(poses_, t);
  if (next != poses_.begin()) poses_.erase(poses_.begin(), next - 1);
}

void Trajectory::move(const Pose& X) {
  for (StampedPose& pose : poses_) pose.X_WB = X * pose.X_WB;
}

std::optional<Pose> Trajectory::at(GpsTime t) const {
  if (poses_.empty() || t < poses_.front().t || poses_.back().t < t) return std::nullopt;
  const auto next = after(poses_, t);
  const StampedPose& a = *(next - 1);
  if (next == poses_.end() || a.t == t) return a.X_WB;
  return interpolate(a.X_WB, next->X_WB, (t - a.t) / (next->t - a.t));
}

}  // namespace canyon
