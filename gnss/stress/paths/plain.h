#pragma once

#include <utility>

#include "canyon/gnss/stress/level_ground.h"

namespace canyon::gnss {

/// A level square of 600 m at that height, and, if it has a height, a box of 20 x 10 m on W's ground about (100, 40).
inline scene::Scene plain_at(double height_m, double box_m) {
  scene::SceneParts parts = level_ground("plain", 300.0, height_m);
  if (box_m > 0.0) {
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("box", scene::ObjectKind::kBuilding);
    mesh.box({100.0, 40.0, 0.5 * box_m}, Eigen::Matrix3d::Identity(), {10.0, 5.0, 0.5 * box_m},
             mesh.material("concrete"));
  }
  return scene::Scene(std::move(parts));
}

}  // namespace canyon::gnss
