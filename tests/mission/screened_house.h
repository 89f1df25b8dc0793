#pragma once

#include <memory>

#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::mission::testing {

/// Level ground of 60 x 60 m around W's origin, z = 0, and "house", 10 m high, whose facade at x = 20 m runs from
/// y = -10 to 10 m. Seen from (0, 0, 1.5) the 5 x 5 points of the facade stand at y = -8, -4, 0, 4, 8 and z = 1, 3, 5,
/// 7, 9 m.
///
/// With a `screen_m` > 0 a screen stands half way, at x = 10 m: 12 m high before the two columns at y < 0, `screen_m`
/// high before the middle one, whose points the sight lines pass it at 1.25, 2.25, 3.25, 4.26 and 5.26 m.
inline std::shared_ptr<const scene::Scene> screened_house(double screen_m) {
  scene::SceneParts parts;
  parts.name = "screened house";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  const std::uint16_t concrete = mesh.material("concrete");
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0}, concrete);

  const auto outline = scene::rectangle(20, -10, 28, 10);
  const std::uint32_t house = mesh.begin_object("house", scene::ObjectKind::kBuilding);
  mesh.block(outline, 0, 10, concrete, concrete);
  scene::Building building;
  building.name = "house";
  building.object = house;
  building.footprint_W = outline;
  building.height_m = 10;
  parts.buildings.push_back(building);

  if (screen_m > 0) {
    mesh.begin_object("screen", scene::ObjectKind::kWall);
    mesh.block(scene::rectangle(9.95, -6, 10.05, -1), 0, 12, concrete, concrete);
    mesh.block(scene::rectangle(9.95, -1, 10.05, 1), 0, screen_m, concrete, concrete);
  }
  return std::make_shared<const scene::Scene>(std::move(parts));
}

/// Heights of the screen that leave 13 and 12 of the 25 points in sight: just over and just under one half.
inline constexpr double kHides12 = 2.75, kHides13 = 3.75;

}  // namespace canyon::mission::testing
