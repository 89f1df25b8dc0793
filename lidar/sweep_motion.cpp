#include "canyon/lidar/sweep_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/check.h"

namespace canyon::lidar {
namespace {

using Numbers = Eigen::Matrix<double, 12, 1>;  // of a placement

// What a chord between two nodes may be off the arc; and nodes are never closer than this.
constexpr double kChordAngle_rad = 3e-8;
constexpr double kChordWay_m = 1e-6;
constexpr double kClosest_s = 5e-6;  // keeps them up to 5000 deg/s

/// A chord over h deviates from an arc of rate w by (w h)^2 / 8 in direction, and in place by the acceleration times
/// h^2 / 8, which on a screw motion is w times the sensor's speed.
double node_spacing_s(const Vector6d& twist_per_s, const Pose& X_BL) {
  const double w_rad_s = twist_per_s.head<3>().norm();
  const double speed_m_s = twist_per_s.tail<3>().norm() + w_rad_s * X_BL.p.norm();
  const double by_angle_s = std::sqrt(8.0 * kChordAngle_rad) / std::max(w_rad_s, 1e-12);
  const double by_way_s = std::sqrt(8.0 * kChordWay_m / std::max(w_rad_s * speed_m_s, 1e-12));
  return std::max(kClosest_s, std::min(by_angle_s, by_way_s));
}

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
    const Vector6d twist = (a.X_WB.inverse() * b.X_WB).log();
    const double length_s = b_s - a_s;
    const double spacing_s = node_spacing_s(twist / length_s, X_BL);
    const int pieces = std::max(1, static_cast<int>(std::ceil((to_s - from_s) / spacing_s - 1e-6)));
    for (int i = 0; i < pieces; ++i) {
      const double time_s = from_s + (to_s - from_s) * i / pieces;
      if (!nodes_.empty() && time_s <= nodes_.back().time_s) continue;
      add(time_s, a.X_WB * Pose::exp(twist * ((time_s - a_s) / length_s)));
    }
    if (to_s >= end_s) add(end_s, a.X_WB * Pose::exp(twist * ((end_s - a_s) / length_s)));
  }
}

std::size_t SweepMotion::before(double time_s, std::size_t& hint) const {
  if (hint + 1 >= nodes_.size() || time_s < nodes_[hint].time_s) {
    const auto next = std::upper_bound(nodes_.begin(), nodes_.end(), time_s,
                                       [](double t, const Node& node) { return t < node.time_s; });
    const auto index = next - nodes_.begin() - 1;
    hint = std::min<std::size_t>(index < 0 ? 0 : static_cast<std::size_t>(index), nodes_.size() - 2);
  }
  while (hint + 2 < nodes_.size() && time_s >= nodes_[hint + 1].time_s) ++hint;
  return hint;
}

SweepMotion::Placement SweepMotion::at(double time_s, std::size_t& hint) const {
  CANYON_CHECK(covers(time_s), "time_s = ", time_s);
  if (nodes_.size() == 1) return nodes_.front().placement;
  const Node& a = nodes_[before(time_s, hint)];
  const Node& b = nodes_[hint + 1];
  const double s = (time_s - a.time_s) / (b.time_s - a.time_s);
  return {a.placement.R + s * (b.placement.R - a.placement.R), a.placement.p + s * (b.placement.p - a.placement.p)};
}

void SweepMotion::Reader::find(double time_s) {
  CANYON_CHECK(motion_.covers(time_s), "time_s = ", time_s);
  const auto& nodes = motion_.nodes_;
  from_s_ = nodes.front().time_s;
  to_s_ = nodes.back().time_s + kTimeTolerance_s;
  if (nodes.size() == 1) {
    stands_ = true;
    from_ = nodes.front().placement;
    return;
  }
  const Node& a = nodes[motion_.before(time_s, hint_)];
  const Node& b = nodes[hint_ + 1];
  from_s_ = a.time_s;
  if (hint_ + 2 < nodes.size()) to_s_ = b.time_s;
  length_s_ = b.time_s - a.time_s;
  from_ = a.placement;
  way_ = {b.placement.R - a.placement.R, b.placement.p - a.placement.p};
}

void SweepMotion::placements(double time_s, double step_s, std::size_t& hint, PlacementPacket& out) const {
  CANYON_CHECK(!nodes_.empty(), "nothing is covered at ", time_s);
  const auto store = [&out](std::size_t lane, const Eigen::Matrix3d& R, const Eigen::Vector3d& p) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) out.R[3 * row + column][lane] = static_cast<float>(R(row, column));
      out.p[row][lane] = static_cast<float>(p[row]);
    }
  };
  if (nodes_.size() == 1) {
    for (std::size_t i = 0; i < PlacementPacket::kShots; ++i) {
      store(i, nodes_.front().placement.R, nodes_.front().placement.p);
    }
    for (int k = 0; k < 3; ++k) out.w_WL_L[k] = out.v_WL_W[k] = 0.0f;
    return;
  }
  constexpr std::size_t kShots = PlacementPacket::kShots;
  const double first_s = nodes_.front().time_s, last_s = nodes_.back().time_s;
  double times_s[kShots];
  for (std::size_t i = 0; i < kShots; ++i)
    times_s[i] = std::clamp(time_s + static_cast<double>(i) * step_s, first_s, last_s);
  static_assert(sizeof(Placement) == 12 * sizeof(double));
  std::size_t segment = before(times_s[0], hint);
  const auto end_s = [&](std::size_t k) {  // of segment k; the last one holds its own end
    return k + 2 < nodes_.size() ? nodes_[k + 1].time_s : std::numeric_limits<double>::infinity();
  };
  const std::size_t next = segment + 1, after_next = std::min(segment + 2, nodes_.size() - 1);
  if (time_s >= first_s && times_s[kShots - 1] < nodes_[after_next].time_s) {  // most often: two segments at most
    const auto of = [&](std::size_t k) { return Eigen::Map<const Numbers>(nodes_[k].placement.R.data()); };
    const Numbers before = (of(next) - of(segment)) / (nodes_[next].time_s - nodes_[segment].time_s);
    const Numbers after =
        after_next == next ? before
                           : Numbers((of(after_next) - of(next)) / (nodes_[after_next].time_s - nodes_[next].time_s));
    bend_placements(nodes_[next].placement.R.data(), before.data(), after.data(), time_s - nodes_[next].time_s, step_s,
                    out);
  } else {
    // Segment by segment, each for the lanes that lie in it.
    for (std::size_t lane = 0; lane < kShots; ++segment) {
      const Node &a = nodes_[segment], &b = nodes_[segment + 1];
      double shares[kShots] = {};
      int among[kShots] = {};
      bool any = false;
      for (; lane < kShots && times_s[lane] < end_s(segment); ++lane) {
        shares[lane] = (times_s[lane] - a.time_s) / (b.time_s - a.time_s);
        among[lane] = 1;
        any = true;
      }
      if (any) spread_some_placements(a.placement.R.data(), b.placement.R.data(), shares, among, out);
    }
  }
  const Node& a = nodes_[before(times_s[kShots / 2], hint)];
  const Node& b = nodes_[hint + 1];
  const double length_s = b.time_s - a.time_s;
  const Eigen::Matrix3d W =
      a.placement.R.transpose() * (b.placement.R - a.placement.R) / length_s;  // skew: first order
  const Eigen::Vector3d w(0.5 * (W(2, 1) - W(1, 2)), 0.5 * (W(0, 2) - W(2, 0)), 0.5 * (W(1, 0) - W(0, 1)));
  for (int k = 0; k < 3; ++k) {
    out.w_WL_L[k] = static_cast<float>(w[k]);
    out.v_WL_W[k] = static_cast<float>((b.placement.p[k] - a.placement.p[k]) / length_s);
  }
}

}  // namespace canyon::lidar
