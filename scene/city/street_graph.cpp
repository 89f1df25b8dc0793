#include "canyon/scene/city/street_graph.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

namespace canyon::scene {
namespace {

/// A point's foot on the nearest street.
struct Projection {
  std::uint32_t edge = 0;
  double along = 0.0;  ///< 0 at node a, 1 at node b
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();
  double distance_m = std::numeric_limits<double>::infinity();
};

std::optional<Projection> project(const StreetGraph& graph, const Eigen::Vector2d& p) {
  Projection best;
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
    const Eigen::Vector2d& a = graph.nodes_W[graph.edges[e].a];
    const Eigen::Vector2d way = graph.nodes_W[graph.edges[e].b] - a;
    const double length2 = way.squaredNorm();
    const double along = length2 > 0.0 ? std::clamp(way.dot(p - a) / length2, 0.0, 1.0) : 0.0;
    const Eigen::Vector2d foot = a + along * way;
    const double distance_m = (p - foot).norm();
    if (distance_m < best.distance_m) best = {e, along, foot, distance_m};
  }
  if (best.distance_m == std::numeric_limits<double>::infinity()) return std::nullopt;
  return best;
}

double length(const StreetGraph& graph, const StreetGraph::Edge& e) {
  return (graph.nodes_W[e.b] - graph.nodes_W[e.a]).norm();
}

}  // namespace

std::vector<Eigen::Vector2d> StreetGraph::route(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  const auto start = project(*this, from), goal = project(*this, to);
  if (!start || !goal) return {};

  // Dijkstra from the two ends of the start's street; ties go to the lower node, so that the way is always the same.
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> cost(nodes_W.size(), kFar);
  std::vector<std::uint32_t> before(nodes_W.size(), 0xffffffffu);
  std::vector<std::vector<std::pair<std::uint32_t, double>>> ways(nodes_W.size());
  for (const Edge& e : edges) {
    ways[e.a].emplace_back(e.b, length(*this, e));
    ways[e.b].emplace_back(e.a, length(*this, e));
  }
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](std::uint32_t node, double c, std::uint32_t via) {
    if (c < cost[node]) {
      cost[node] = c;
      before[node] = via;
      open.emplace(c, node);
    }
  };
  const Edge& first = edges[start->edge];
  reach(first.a, start->along * length(*this, first), 0xffffffffu);
  reach(first.b, (1.0 - start->along) * length(*this, first), 0xffffffffu);
  while (!open.empty()) {
    const auto [c, node] = open.top();
    open.pop();
    if (c > cost[node]) continue;
    for (const auto& [next, step] : ways[node]) reach(next, c + step, node);
  }

  const Edge& last = edges[goal->edge];
  const double by_a = cost[last.a] + goal->along * length(*this, last);
  const double by_b = cost[last.b] + (1.0 - goal->along) * length(*this, last);
  const bool same_street = start->edge == goal->edge;  // streets are straight: nothing is shorter
  if (!same_street && std::min(by_a, by_b) == kFar) return {};

  std::vector<Eigen::Vector2d> points{goal->foot};
  if (!same_street) {
    for (std::uint32_t node = by_b < by_a ? last.b : last.a; node != 0xffffffffu; node = before[node])
      points.push_back(nodes_W[node]);
  }
  points.push_back(start->foot);
  std::reverse(points.begin(), points.end());
  // A projection that falls on a node (waypoints are written with millimetres) would repeat it.
  const auto same = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return (a - b).norm() < 1e-3; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  return points;
}

double StreetGraph::distance_to(const Eigen::Vector2d& p) const {
  const auto projection = project(*this, p);
  return projection ? projection->distance_m : std::numeric_limits<double>::infinity();
}

}  // namespace canyon::scene
