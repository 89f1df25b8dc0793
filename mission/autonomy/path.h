#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace canyon::mission {

/// A planar path in W by arc length, sampled densely; what the street route becomes once its corners are rounded.
class Path {
 public:
  Path() = default;
  /// Rounds the corners of a polyline with arcs of at most `corner_radius_m` (less where a leg is too short) and
  /// samples every `spacing_m`. Repeated points are merged.
  Path(const std::vector<Eigen::Vector2d>& polyline, double corner_radius_m, double spacing_m = 0.25);

  bool empty() const { return points_.size() < 2; }
  double length_m() const { return empty() ? 0.0 : s_.back(); }
  const std::vector<Eigen::Vector2d>& points() const { return points_; }

  Eigen::Vector2d at(double s_m) const;         ///< clamped to the ends
  Eigen::Vector2d direction(double s_m) const;  ///< unit
  double curvature(double s_m) const;           ///< left positive, 1/m

  /// Arc length of the point nearest to p within [from_m, to_m].
  double project(const Eigen::Vector2d& p, double from_m, double to_m) const;
  /// Signed distance of p from the path at s, left positive.
  double offset(const Eigen::Vector2d& p, double s_m) const;

 private:
  std::size_t index(double s_m) const;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> s_;
};

/// Largest speeds along a path: in turns by lateral acceleration and turn rate, then by braking ahead of slower places
/// and accelerating behind them; zero at each of `stops_m`.
struct SpeedLimits {
  double cruise_m_s, lateral_m_s2, acceleration_m_s2, deceleration_m_s2;
  double max_yaw_rate_rad_s = std::numeric_limits<double>::infinity();
};
/// Time to drive the path at those speeds, s; halts not included.
double nominal_drive_time_s(const Path& path, const SpeedLimits& limits, const std::vector<double>& stops_m);

}  // namespace canyon::mission
