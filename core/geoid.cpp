#include "core/geoid.h"

#include <GeographicLib/Geoid.hpp>

#include <exception>

#include "core/units.h"

namespace canyon {

std::optional<GeoidHeight> geoid_height(const Geodetic& g) {
  for (const char* model : {"egm2008-1", "egm2008-2_5", "egm2008-5", "egm96-5", "egm96-15", "egm84-15", "egm84-30"}) {
    try {
      const GeographicLib::Geoid geoid(model);
      return GeoidHeight{geoid(g.lat_rad / kDegree, g.lon_rad / kDegree), model};
    } catch (const std::exception&) {
      // not installed: the next one
    }
  }
  return std::nullopt;
}

}  // namespace canyon
