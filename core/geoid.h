#pragma once

#include <optional>
#include <string>

#include "core/earth.h"

namespace canyon {

/// Height of the geoid above the WGS84 ellipsoid, and the model it is from ("egm96-5").
struct GeoidHeight {
  double undulation_m = 0.0;
  std::string model;
};

/// From the finest of GeographicLib's geoid models that is installed (its default folders, or
/// GEOGRAPHICLIB_GEOID_PATH); nullopt where there is none.
std::optional<GeoidHeight> geoid_height(const Geodetic& g);

}  // namespace canyon
