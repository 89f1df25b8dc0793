#include "canyon/scene/elevation/terrain_file.h"

#include <utility>

namespace canyon::scene {

Result<TerrainFile> TerrainFile::read(const std::string& path, const std::string& crs) {
  CANYON_TRY(Elevation elevation, read_elevation(path));
  if (elevation.frame.crs.empty() && crs.empty())
    return Error{path, 0, "crs", "does not say its coordinate system",
                 "a GeoTIFF that does, a .prj beside it, or scene.crs"};
  const SourceFrame frame =
      elevation.frame.crs.empty() ? SourceFrame{crs, false} : SourceFrame{elevation.frame.crs, false};
  CANYON_TRY(Projection projection, Projection::make(frame, path, "crs"));
  return TerrainFile(std::move(elevation), std::move(projection));
}

std::optional<double> TerrainFile::height(const Geodetic& g) const {
  const auto p = projection_.from_geodetic(g);
  return p ? elevation_.height(*p) : std::nullopt;
}

}  // namespace canyon::scene
