#pragma once

#include <string>
#include <vector>

#include "canyon/core/files/ascii_grid.h"
#include "canyon/scene/scene.h"

namespace canyon::scene {

struct MaterialArea {
  std::string name;
  std::size_t triangles = 0;
  double area_m2 = 0.0;
};

/// How sound the surfaces of a scene are. Each object is looked at by itself, corners at the same place count as one;
/// terrain and trees are left out. An edge below the terrain is not open: nothing looks in there.
struct Soundness {
  std::size_t objects = 0;        ///< looked at
  std::size_t watertight = 0;     ///< every edge belongs to two triangles
  std::size_t open_edges = 0;     ///< of one triangle only
  std::size_t crowded_edges = 0;  ///< of more than two
  std::size_t flipped_edges = 0;  ///< of two triangles that face opposite ways
  std::size_t inside_out = 0;     ///< watertight objects whose triangles face inwards
  std::size_t repeated_triangles = 0;
};

/// What a sensor's run needs of a scene, and what it does not.
struct SensorNeeds {
  std::size_t facets = 0, reflecting_facets = 0;  ///< GNSS: mirrors of at least Scene::kMinFacetArea_m2
  std::size_t edges = 0;                          ///< GNSS: edges that diffract
  std::size_t tree_triangles = 0;                 ///< LIDAR only: GNSS takes crowns as volumes
  std::size_t near_triangles = 0;                 ///< LIDAR: within `lidar_reach_m` of a street
  double lidar_reach_m = 120.0;
  bool specular = false, retro = false, transparent = false;  ///< LIDAR: materials in use that need more than diffuse
  std::vector<std::string> gnss, lidar;                       ///< in words
};

std::vector<MaterialArea> material_areas(const Scene& scene);
Soundness soundness(const Scene& scene);
SensorNeeds sensor_needs(const Scene& scene);

/// Height above the ground of what is seen from above, by rays down in cells of `cell_m`, larger where there would be
/// more than 4000 to a side; NaN where there is nothing. The scene has triangles.
Grid heights_from_above(const Scene& scene, double cell_m);

}  // namespace canyon::scene
