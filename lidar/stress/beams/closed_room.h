#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Core>

#include "canyon/core/time.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

/// Where and when the cases of whole scans are scanned.
namespace canyon::lidar::made {

inline constexpr GpsTime kScanAt{1'100'000'000'000'000'000};

/// A closed room of 80 x 70 x 12 m on the plane z = 0, with pillars if there are any.
inline std::unique_ptr<scene::Scene> closed_room(bool pillars) {
  scene::SceneParts parts;
  parts.name = "room";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("room", scene::ObjectKind::kBuilding);
  mesh.box({0, 0, 6}, Eigen::Matrix3d::Identity(), {40, 35, 6}, mesh.material("concrete"));
  mesh.begin_object("pillars", scene::ObjectKind::kPole);
  for (int k = 0; pillars && k < 9; ++k)
    mesh.box({13.0 * std::cos(0.7 * k), 13.0 * std::sin(0.7 * k), 2.5}, Eigen::Matrix3d::Identity(), {0.4, 0.3, 2.5},
             mesh.material("brick"));
  return std::make_unique<scene::Scene>(std::move(parts));
}

}  // namespace canyon::lidar::made
