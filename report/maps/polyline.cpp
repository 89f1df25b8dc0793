#include "canyon/report/maps/polyline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace canyon::report {
namespace {

/// Distance of p from the segment a-b, not from its endless line: that is what keeps turning points.
double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double s = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - s * ab).norm();
}

}  // namespace

std::vector<std::size_t> simplify_polyline(const std::vector<Eigen::Vector2d>& points, double tolerance_m) {
  std::vector<std::size_t> kept;
  if (points.empty()) return kept;
  std::vector<char> keep(points.size(), 0);
  keep.front() = keep.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double worst_m = tolerance_m;
    std::size_t worst = 0;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double d_m = distance_to_segment(points[i], points[a], points[b]);
      if (d_m > worst_m) worst_m = d_m, worst = i;
    }
    if (worst == 0) continue;
    keep[worst] = 1;
    open.emplace_back(a, worst);
    open.emplace_back(worst, b);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (keep[i]) kept.push_back(i);
  }
  return kept;
}

}  // namespace canyon::report
