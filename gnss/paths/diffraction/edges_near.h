#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/gnss/paths/plane_waves.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {

/// An edge of the scene and a wave that may bend there: indices into EdgeIndex::edges() and of the wave.
struct EdgeAndWave {
  std::uint32_t edge, wave;
};

/// Every edge of the scene at which a wave may bend towards p with a detour of at most `detour_m`, with that wave, and
/// few others; in a fixed order, all waves of an edge together. Replaces what is in `out`. There must be waves.
void find_edges_near(const Eigen::Vector3d& p_W, const PlaneWaves& waves, const scene::SceneAt& scene, double detour_m,
                     std::vector<EdgeAndWave>& out);

/// Calls look(edge, k) for each of them.
template <class Look>
void look_at_edges_near(const Eigen::Vector3d& p_W, const PlaneWaves& waves, const scene::SceneAt& scene,
                        double detour_m, Look look) {
  thread_local std::vector<EdgeAndWave> near;
  find_edges_near(p_W, waves, scene, detour_m, near);
  const auto& edges = scene.scene().edges().edges();
  for (const EdgeAndWave& one : near) look(edges[one.edge], static_cast<std::size_t>(one.wave));
}

}  // namespace canyon::gnss
