#include "canyon/scene/flat_ground.h"

#include "canyon/scene/city/city.h"

namespace canyon::scene {

const Scene& flat_ground() {
  static const Scene kGround = [] {
    CityConfig config;
    config.empty = true;
    config.extent_m = kCityExtent_m.min;
    config.slope_percent = config.hill_height_m = 0.0;
    return Scene(make_city(config));
  }();
  return kGround;
}

}  // namespace canyon::scene
