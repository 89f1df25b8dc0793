#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "canyon/gnss/paths/plane_waves.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {

/// Calls look(edge, k) for every edge of the scene at which wave k may bend towards p with a detour of at most
/// `detour_m`, in a fixed order, and for few others. There must be waves.
template <class Look>
void look_at_edges_near(const Eigen::Vector3d& p_W, const PlaneWaves& waves, const scene::SceneAt& scene,
                        double detour_m, Look look) {
  const auto& edges = scene.scene().edges();
  double lowest = 1.0;
  for (const Eigen::Vector3d& s : waves.directions_W()) lowest = std::min(lowest, s.z());
  thread_local std::vector<std::uint32_t> candidates;
  edges.shading(p_W, std::asin(std::clamp(lowest, 0.0, 1.0)), detour_m, candidates);
  for (const std::uint32_t i : candidates) {
    const scene::Edge& edge = edges.edges()[i];
    const Eigen::Vector3d to_middle_W = 0.5 * (edge.a_W + edge.b_W) - p_W;
    const double half_m = 0.5 * (edge.b_W - edge.a_W).norm(), distance_m = to_middle_W.norm();
    // The whole edge, and how far a wave may bend there, lie in a cone around its middle.
    const double near_m = std::max(distance_m - half_m, 0.1);
    const double angle_rad = std::asin(std::min(half_m / distance_m, 1.0)) + 1.1 * std::sqrt(2.0 * detour_m / near_m);
    const double least = angle_rad < 3.0 ? std::cos(angle_rad) * distance_m : -distance_m;
    for (std::size_t k = 0; k < waves.directions_W().size(); ++k)
      if (to_middle_W.dot(waves.direction_W(k)) >= least) look(edge, k);
  }
}

}  // namespace canyon::gnss
