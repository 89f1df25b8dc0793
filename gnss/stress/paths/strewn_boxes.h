#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {

/// Boxes in all directions, turned and tilted, of all sizes.
inline std::unique_ptr<scene::Scene> strewn_boxes(std::uint64_t seed, int count, bool upright,
                                                  double farthest_m = 120.0) {
  const RandomStream draws(seed, "stress.shortcuts");
  scene::SceneParts parts;
  parts.name = "strewn";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::uint64_t>(i);
    mesh.begin_object("box " + std::to_string(i), scene::ObjectKind::kBuilding);
    const Eigen::Vector3d half(draws.uniform(0.5, 6.0, 0, k), draws.uniform(0.5, 6.0, 1, k),
                               draws.uniform(0.5, 9.0, 2, k));
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(draws.uniform(0, 6.2, 3, k), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(upright ? 0.0 : draws.uniform(-0.6, 0.6, 4, k), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    const double away_m = draws.uniform(12.0, farthest_m, 5, k), bearing = draws.uniform(0, 6.2832, 6, k);
    mesh.box({away_m * std::cos(bearing), away_m * std::sin(bearing), draws.uniform(-3.0, 12.0, 7, k)}, turn, half,
             mesh.material(i % 3 == 0 ? "metal" : "concrete"));
  }
  return std::make_unique<scene::Scene>(std::move(parts));
}

}  // namespace canyon::gnss
