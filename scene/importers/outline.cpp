#include "canyon/scene/importers/outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace canyon::scene {

std::vector<std::vector<Eigen::Vector3d>> border_rings(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles) {
  using Key = std::array<long long, 3>;
  std::map<Key, std::uint32_t> ids;
  std::vector<Eigen::Vector3d> places;
  const auto id_of = [&](const Eigen::Vector3d& p) {
    const Key key{std::llround(p.x() * 1e3), std::llround(p.y() * 1e3), std::llround(p.z() * 1e3)};
    const auto [entry, fresh] = ids.try_emplace(key, static_cast<std::uint32_t>(places.size()));
    if (fresh) places.push_back(p);
    return entry->second;
  };
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& triangle : triangles) {
    if (!triangle[0].allFinite() || !triangle[1].allFinite() || !triangle[2].allFinite()) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = id_of(triangle[k]), b = id_of(triangle[(k + 1) % 3]);
      if (a != b && edges.erase({b, a}) == 0) edges.insert({a, b});
    }
  }
  std::vector<std::vector<Eigen::Vector3d>> rings;
  while (!edges.empty()) {
    const std::uint32_t first = edges.begin()->first;
    std::vector<Eigen::Vector3d> ring;
    std::uint32_t at = first;
    for (;;) {
      const auto edge = edges.lower_bound({at, 0});
      if (edge == edges.end() || edge->first != at) {
        ring.clear();  // ends nowhere
        break;
      }
      ring.push_back(places[at]);
      at = edge->second;
      edges.erase(edge);
      if (at == first) break;
    }
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  }
  return rings;
}

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  // Andrew's monotone chain.
  std::vector<Eigen::Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const Eigen::Vector2d& p : points) {
      while (hull.size() >= begin + 2) {
        const Eigen::Vector2d a = hull[hull.size() - 1] - hull[hull.size() - 2], b = p - hull[hull.size() - 2];
        if (a.x() * b.y() - a.y() * b.x() > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace canyon::scene
