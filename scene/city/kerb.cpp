#include "canyon/scene/city/kerb.h"

namespace canyon::scene::city {

std::vector<Kerb> kerbs(const Plan& plan) {
  std::vector<Kerb> all;
  for (const StreetGraph::Edge& e : plan.streets.edges) {
    const Eigen::Vector2d a = plan.streets.nodes_W[e.a], b = plan.streets.nodes_W[e.b];
    const Eigen::Vector2d along = (b - a).normalized(), left(-along.y(), along.x());
    for (const Eigen::Vector2d& across : {left, Eigen::Vector2d(-left)}) {
      all.push_back({a, along, across, (b - a).norm(), plan.zone_near(0.5 * (a + b) + e.width_m * across)});
    }
  }
  return all;
}

}  // namespace canyon::scene::city
