#include "canyon/scene/surfaces/triangulate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

namespace canyon::scene {
namespace {

using Points = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// p inside the counter-clockwise triangle or on its border, its corners left out.
bool covers(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& p) {
  return p != a && p != b && p != c && cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0;
}

/// Joins a hole to the polygon: from the hole's easternmost corner to a corner of the polygon that it sees.
void bridge(const Points& points, const std::vector<std::uint32_t>& hole, std::vector<std::uint32_t>& polygon) {
  const auto rightmost = std::max_element(
      hole.begin(), hole.end(), [&](std::uint32_t a, std::uint32_t b) { return points[a].x() < points[b].x(); });
  const Eigen::Vector2d m = points[*rightmost];
  // The edge that a ray eastward meets first, and the end of it that lies farther east.
  double nearest_x = std::numeric_limits<double>::infinity();
  std::size_t seen = polygon.size();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    const Eigen::Vector2d &a = points[polygon[i]], &b = points[polygon[j]];
    if (!(std::min(a.y(), b.y()) <= m.y() && m.y() <= std::max(a.y(), b.y())) || a.y() == b.y()) continue;
    const double x = a.x() + (m.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y());
    if (x < m.x() || x >= nearest_x) continue;
    nearest_x = x;
    // Where the ray meets a corner it sees that one.
    seen = a.y() == m.y() ? i : b.y() == m.y() ? j : a.x() > b.x() ? i : j;
  }
  if (seen == polygon.size()) return;  // the hole lies outside: nothing to cut
  // Corners inside the triangle from m to the edge hide that end: the one closest to the ray is seen.
  const Eigen::Vector2d at(nearest_x, m.y()), p = points[polygon[seen]];
  double flattest = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d &second = p.y() > m.y() ? at : p, &third = p.y() > m.y() ? p : at;
  for (std::size_t i = 0; p.y() != m.y() && i < polygon.size(); ++i) {
    const Eigen::Vector2d& q = points[polygon[i]];
    if (q == p || q.x() < m.x() || !covers(m, second, third, q)) continue;
    const Eigen::Vector2d d = q - m;
    const double steepness = std::abs(d.y()) / std::max(d.x(), 1e-300);
    if (steepness < flattest) {
      flattest = steepness;
      seen = i;
    }
  }
  // Bridges have made several corners of one place: the one whose inside m lies in.
  const Eigen::Vector2d end = points[polygon[seen]];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (points[polygon[i]] != end) continue;
    const Eigen::Vector2d& before = points[polygon[(i + polygon.size() - 1) % polygon.size()]];
    const Eigen::Vector2d& after = points[polygon[(i + 1) % polygon.size()]];
    const bool left_in = cross(before, end, m) >= 0.0, left_out = cross(end, after, m) >= 0.0;
    if (cross(before, end, after) > 0.0 ? left_in && left_out : left_in || left_out) {
      seen = i;
      break;
    }
  }
  std::vector<std::uint32_t> cut(rightmost, hole.end());
  cut.insert(cut.end(), hole.begin(), rightmost);
  cut.push_back(*rightmost);
  cut.push_back(polygon[seen]);
  polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(seen) + 1, cut.begin(), cut.end());
}

std::vector<std::array<std::uint32_t, 3>> clip_ears(const Points& points, std::vector<std::uint32_t> polygon) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t i = 0, failed = 0;
  while (polygon.size() > 3) {
    const std::size_t n = polygon.size();
    i %= n;
    const std::uint32_t before = polygon[(i + n - 1) % n], ear = polygon[i], after = polygon[(i + 1) % n];
    const Eigen::Vector2d &a = points[before], &b = points[ear], &c = points[after];
    bool clipped = a == b || b == c;  // a repeated corner
    if (!clipped) {
      // After a whole round without an ear the polygon crosses itself; take what is convex, then anything.
      clipped = failed >= 2 * n || (cross(a, b, c) > 0.0 &&
                                    (failed >= n || std::none_of(polygon.begin(), polygon.end(), [&](std::uint32_t p) {
                                       return covers(a, b, c, points[p]);
                                     })));
      if (clipped && cross(a, b, c) > 0.0) triangles.push_back({before, ear, after});
    }
    if (clipped) {
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
      failed = 0;
      // The next but one: fans give slivers.
    } else {
      ++failed;
    }
    ++i;
  }
  if (polygon.size() == 3 && cross(points[polygon[0]], points[polygon[1]], points[polygon[2]]) > 0.0)
    triangles.push_back({polygon[0], polygon[1], polygon[2]});
  return triangles;
}

}  // namespace

double twice_area(const std::vector<Eigen::Vector2d>& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

bool polygon_contains(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Eigen::Vector2d &a = ring[i], &b = ring[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y())) {
      inside = !inside;
    }
  }
  return inside;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<std::vector<Eigen::Vector2d>>& rings) {
  if (rings.empty() || rings[0].size() < 3) return {};
  Points points;
  std::vector<std::vector<std::uint32_t>> indices;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    std::vector<std::uint32_t> ring(rings[r].size());
    std::iota(ring.begin(), ring.end(), static_cast<std::uint32_t>(points.size()));
    // Small numbers: coordinates of maps have seven digits before the point.
    for (const Eigen::Vector2d& p : rings[r]) points.push_back(p - rings[0][0]);
    if ((twice_area(rings[r]) > 0.0) != (r == 0)) std::reverse(ring.begin(), ring.end());
    if (ring.size() >= 3) indices.push_back(std::move(ring));
  }
  for (const Eigen::Vector2d& p : points)
    if (!p.allFinite()) return {};
  std::vector<std::uint32_t> polygon = std::move(indices[0]);
  const auto east = [&](const std::vector<std::uint32_t>& ring) {
    double x = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : ring) x = std::max(x, points[i].x());
    return x;
  };
  std::stable_sort(indices.begin() + 1, indices.end(), [&](const auto& a, const auto& b) { return east(a) > east(b); });
  for (std::size_t r = 1; r < indices.size(); ++r) bridge(points, indices[r], polygon);
  return clip_ears(points, std::move(polygon));
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<std::vector<Eigen::Vector3d>>& rings) {
  if (rings.empty() || rings[0].size() < 3) return {};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector3d>& outer = rings[0];
  for (std::size_t i = 0; i < outer.size(); ++i)
    normal += (outer[i] - outer[0]).cross(outer[(i + 1) % outer.size()] - outer[0]);
  if (!(normal.squaredNorm() > 0.0)) return {};
  const Eigen::Vector3d n = normal.normalized();
  const Eigen::Vector3d u =
      (std::abs(n.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX()).cross(n).normalized();
  const Eigen::Vector3d v = n.cross(u);
  std::vector<std::vector<Eigen::Vector2d>> flat;
  for (const auto& ring : rings) {
    flat.emplace_back();
    for (const Eigen::Vector3d& p : ring) flat.back().emplace_back((p - outer[0]).dot(u), (p - outer[0]).dot(v));
  }
  return triangulate(flat);
}

}  // namespace canyon::scene
