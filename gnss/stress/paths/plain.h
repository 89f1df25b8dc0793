#pragma once

#include <utility>

#include "canyon/core/earth/local_frame.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {

/// A level square of 600 m at that height, and, if it has a height, a box of 20 x 10 m on W's ground about (100, 40).
inline scene::Scene plain_at(double height_m, double box_m) {
  scene::SceneParts parts;
  parts.name = "plain";
  parts.frame = LocalFrame(Geodetic{0.5646, -1.586, 60.0});
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-300, -300, height_m}, {300, -300, height_m}, {300, 300, height_m}, {-300, 300, height_m},
            mesh.material("asphalt"));
  if (box_m > 0.0) {
    mesh.begin_object("box", scene::ObjectKind::kBuilding);
    mesh.box({100.0, 40.0, 0.5 * box_m}, Eigen::Matrix3d::Identity(), {10.0, 5.0, 0.5 * box_m},
             mesh.material("concrete"));
  }
  return scene::Scene(std::move(parts));
}

}  // namespace canyon::gnss
