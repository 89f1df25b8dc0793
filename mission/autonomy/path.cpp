#include "canyon/mission/autonomy/path.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"

namespace canyon::mission {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::vector<Eigen::Vector2d> without_repeats(const std::vector<Eigen::Vector2d>& polyline) {
  std::vector<Eigen::Vector2d> out;
  for (const auto& p : polyline)
    if (out.empty() || (p - out.back()).norm() > 1e-3) out.push_back(p);
  return out;
}

/// Replaces each corner by points of a tangent arc.
std::vector<Eigen::Vector2d> rounded(const std::vector<Eigen::Vector2d>& polyline, double radius_m, double spacing_m) {
  std::vector<Eigen::Vector2d> out{polyline.front()};
  for (std::size_t i = 1; i + 1 < polyline.size(); ++i) {
    const Eigen::Vector2d before = polyline[i] - polyline[i - 1], after = polyline[i + 1] - polyline[i];
    const Eigen::Vector2d u = before.normalized(), v = after.normalized();
    const double turn = std::atan2(cross(u, v), u.dot(v));
    if (std::abs(turn) < 1e-3) {
      out.push_back(polyline[i]);
      continue;
    }
    // Tangent length radius * tan(turn / 2) may use half of either leg.
    const double tangent_per_radius = std::abs(std::tan(0.5 * turn));
    const double tangent = std::min(radius_m * tangent_per_radius, 0.49 * std::min(before.norm(), after.norm()));
    const double radius = tangent / tangent_per_radius;
    const Eigen::Vector2d normal = (turn > 0 ? 1.0 : -1.0) * Eigen::Vector2d(-u.y(), u.x());
    const Eigen::Vector2d start = polyline[i] - tangent * u, center = start + radius * normal;
    const int pieces = std::max(2, static_cast<int>(std::ceil(radius * std::abs(turn) / spacing_m)));
    for (int k = 0; k <= pieces; ++k) {
      const double angle = turn * k / pieces;
      const Eigen::Vector2d arm = start - center;
      out.push_back(center + Eigen::Vector2d(std::cos(angle) * arm.x() - std::sin(angle) * arm.y(),
                                             std::sin(angle) * arm.x() + std::cos(angle) * arm.y()));
    }
  }
  out.push_back(polyline.back());
  return out;
}

}  // namespace

Path::Path(const std::vector<Eigen::Vector2d>& polyline, double corner_radius_m, double spacing_m) {
  CANYON_CHECK(spacing_m > 0, "spacing_m = ", spacing_m);
  const auto clean = without_repeats(polyline);
  if (clean.size() < 2) return;
  const auto fine = without_repeats(rounded(clean, corner_radius_m, spacing_m));
  for (std::size_t i = 0; i + 1 < fine.size(); ++i) {
    const int pieces = std::max(1, static_cast<int>(std::ceil((fine[i + 1] - fine[i]).norm() / spacing_m)));
    for (int k = 0; k < pieces; ++k) points_.push_back(fine[i] + (fine[i + 1] - fine[i]) * k / pieces);
  }
  points_.push_back(fine.back());
  s_.assign(points_.size(), 0.0);
  for (std::size_t i = 1; i < points_.size(); ++i) s_[i] = s_[i - 1] + (points_[i] - points_[i - 1]).norm();
}

std::size_t Path::index(double s_m) const {
  const auto upper = std::upper_bound(s_.begin(), s_.end(), s_m);
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, upper - s_.begin() - 1));
  return std::min(i, points_.size() - 2);
}

Eigen::Vector2d Path::at(double s_m) const {
  const double s = std::clamp(s_m, 0.0, length_m());
  const std::size_t i = index(s);
  return points_[i] + (points_[i + 1] - points_[i]) * ((s - s_[i]) / (s_[i + 1] - s_[i]));
}

Eigen::Vector2d Path::direction(double s_m) const {
  const std::size_t i = index(s_m);
  return (points_[i + 1] - points_[i]).normalized();
}

double Path::curvature(double s_m) const {
  constexpr double kSpan = 1.0;  // m, to either side: the path is a polyline
  const Eigen::Vector2d a = direction(s_m - kSpan), b = direction(s_m + kSpan);
  return std::atan2(cross(a, b), a.dot(b)) / (2.0 * kSpan);
}

double Path::project(const Eigen::Vector2d& p, double from_m, double to_m) const {
  double best = std::clamp(from_m, 0.0, length_m()), best_distance = (at(best) - p).squaredNorm();
  const std::size_t last = index(std::min(to_m, length_m()));
  for (std::size_t i = index(from_m); i <= last; ++i) {
    const Eigen::Vector2d leg = points_[i + 1] - points_[i];
    const double t = std::clamp((p - points_[i]).dot(leg) / leg.squaredNorm(), 0.0, 1.0);
    const double s = s_[i] + t * leg.norm();
    if (s < from_m || s > to_m) continue;
    const double distance = (points_[i] + t * leg - p).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best = s;
    }
  }
  return best;
}

double Path::offset(const Eigen::Vector2d& p, double s_m) const {
  return cross(direction(s_m), p - at(s_m));
}

double nominal_drive_time_s(const Path& path, const SpeedLimits& limits, const std::vector<double>& stops_m) {
  constexpr double kStep = 0.5;
  const auto n = static_cast<std::size_t>(std::ceil(path.length_m() / kStep)) + 1;
  std::vector<double> v(n, limits.cruise_m_s);
  for (std::size_t i = 0; i < n; ++i) {
    const double curvature = std::abs(path.curvature(static_cast<double>(i) * kStep));
    if (curvature > 1e-6)
      v[i] = std::min({v[i], std::sqrt(limits.lateral_m_s2 / curvature), limits.max_yaw_rate_rad_s / curvature});
  }
  for (const double stop : stops_m) v[std::min(n - 1, static_cast<std::size_t>(std::llround(stop / kStep)))] = 0.0;
  v.front() = 0.0;
  for (std::size_t i = 1; i < n; ++i)
    v[i] = std::min(v[i], std::sqrt(v[i - 1] * v[i - 1] + 2 * limits.acceleration_m_s2 * kStep));
  for (std::size_t i = n - 1; i-- > 0;)
    v[i] = std::min(v[i], std::sqrt(v[i + 1] * v[i + 1] + 2 * limits.deceleration_m_s2 * kStep));
  double time_s = 0.0;
  for (std::size_t i = 1; i < n; ++i) time_s += kStep / std::max(0.5 * (v[i] + v[i - 1]), 1e-3);
  return time_s;
}

}  // namespace canyon::mission
