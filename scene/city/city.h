#pragma once

#include <cstdint>
#include <memory>

#include "canyon/core/config/config.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_cost.h"

namespace canyon::scene {

/// The built-in, seeded city: terrain with slope, a street grid, buildings of mixed height and material with a dense,
/// tall quarter and open edges, trees, parked vehicles, walls and poles. The same configuration always gives the same
/// city.
struct CityConfig {
  std::int64_t seed = 2012;
  double lat_deg = 32.35;
  double lon_deg = -90.88;
  double extent_m = 1000.0;     ///< edge of the square
  double base_height_m = 60.0;  ///< ellipsoidal height of W's origin
  double slope_percent = 3.0;   ///< mean slope of the terrain, rising to the north-east
  double hill_height_m = 6.0;   ///< rolling on top of the slope
  double terrain_cell_m = 2.0;
  double block_m = 90.0;  ///< street to street
  double street_width_m = 12.0;
  double kerb_height_m = 0.0;  ///< by how much pavements are raised; 0: they are painted on the ground
  bool empty = false;          ///< terrain and streets only: open sky
  bool absorbing = false;      ///< every surface absorbs radio: blockage without reflections
};
void visit(FieldVisitor& f, CityConfig& c);

/// What may be asked of the city, in a mission file and on the command line.
inline constexpr Range kCityExtent_m{300.0, 3000.0};
inline constexpr Range kCityBlock_m{60.0, 200.0};
inline constexpr Range kCitySlope_percent{0.0, 8.0};

/// About how many triangles it will have: ground to the triangle, the rest by the area.
SceneCost predicted_cost(const CityConfig& config);

SceneParts make_city(const CityConfig& config);

}  // namespace canyon::scene
