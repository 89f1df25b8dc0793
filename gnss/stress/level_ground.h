#pragma once

#include <string>
#include <utility>

#include "canyon/core/earth/local_frame.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {

/// A scene under construction at 32 degrees north: a level square of asphalt about W's origin, for more to be built on.
inline scene::SceneParts level_ground(std::string name, double half_m, double height_m) {
  scene::SceneParts parts;
  parts.name = std::move(name);
  parts.frame = LocalFrame(Geodetic{0.5646, -1.586, 60.0});
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-half_m, -half_m, height_m}, {half_m, -half_m, height_m}, {half_m, half_m, height_m},
            {-half_m, half_m, height_m}, mesh.material("asphalt"));
  return parts;
}

}  // namespace canyon::gnss
