#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// Streets as a vehicle knows them beforehand: centre lines, no obstacles.
struct StreetGraph {
  struct Edge {
    std::uint32_t a = 0, b = 0;  ///< node indices
    double width_m = 0.0;        ///< kerb to kerb
  };
  std::vector<Eigen::Vector2d> nodes_W;
  std::vector<Edge> edges;

  /// Shortest way along centre lines from near `from` to near `to`, both projected onto their nearest street; polyline
  /// in W from the projection of `from` to the projection of `to`. Empty if the graph is empty or does not connect
  /// them.
  std::vector<Eigen::Vector2d> route(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  /// Distance from a point to the nearest centre line, m; infinity if there are no streets.
  double distance_to(const Eigen::Vector2d& p) const;
};

}  // namespace canyon::scene
