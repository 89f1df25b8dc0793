#pragma once

#include "canyon/core/random/random.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::scene {

struct TreeShape {
  double crown_center_m;  ///< above ground
  Eigen::Vector3d radii_m;
};

/// Adds a tree that stands at foot_W to the builder's current object: trunk and clumps of leaves as triangles, the
/// crown as Foliage. The clumps are the draws of `number` in the stream.
void add_tree(const Eigen::Vector3d& foot_W, const TreeShape& shape, const RandomStream& leaves, std::size_t number,
              MeshBuilder& mesh, SceneParts& parts);

}  // namespace canyon::scene
