#pragma once

#include "canyon/scene/city/city.h"
#include "canyon/scene/scene.h"

namespace canyon::mission {

/// Flat streets without a house, 300 m square: made once, for the cases that need ground under them.
inline const scene::Scene& open_ground() {
  static const scene::Scene kGround = [] {
    scene::CityConfig config;
    config.empty = true;
    config.extent_m = scene::kCityExtent_m.min;
    config.slope_percent = config.hill_height_m = 0.0;
    return scene::Scene(scene::make_city(config));
  }();
  return kGround;
}

}  // namespace canyon::mission
