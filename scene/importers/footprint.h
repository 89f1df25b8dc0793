#pragma once

#include "canyon/scene/importers/raw_scene.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::scene {

/// Adds a footprint's walls from `bottom_m` and its roof over `base_m` (the ground it is measured from) to the mesh.
/// Pitched roofs need a convex outline without courtyards: over other outlines the roof is flat, at the full height;
/// returns false then.
bool add_footprint(const RawFootprint& footprint, double bottom_m, double base_m, std::uint16_t wall,
                   std::uint16_t roof, MeshBuilder& mesh);

}  // namespace canyon::scene
