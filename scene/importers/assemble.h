#pragma once

#include <vector>

#include "canyon/scene/import.h"
#include "canyon/scene/importers/raw_scene.h"

namespace canyon::scene {

/// Heights of the ground that the files tell beside their surfaces: of footprints, and bottoms of buildings, in W.
std::vector<Eigen::Vector3d> ground_points(const std::vector<RawScene>& scenes);

/// About how many triangles that takes, trees and walls included; terrain that is made is not.
double triangles_of(const RawScene& scene);

/// Turns what was read, already in W, into the mesh, objects, buildings and streets of a scene. parts.materials and
/// parts.frame are there; so is the terrain, unless the files have their own.
void assemble(const std::vector<RawScene>& scenes, const ImportConfig& config, SceneParts& parts, ImportReport& report);

}  // namespace canyon::scene
