#pragma once

#include <optional>
#include <string>

#include "canyon/scene/elevation/elevation.h"
#include "canyon/scene/projection.h"

namespace canyon::scene {

/// An elevation model and its place on Earth.
class TerrainFile {
 public:
  /// `crs`: the coordinate system of one that does not say its own. An Error if there is neither.
  static Result<TerrainFile> read(const std::string& path, const std::string& crs);

  /// Of the ground at a latitude and longitude, above what ellipsoidal() says, m; none where it does not reach.
  std::optional<double> height(const Geodetic& g) const;
  /// Whether heights are above the ellipsoid; else above the geoid.
  bool ellipsoidal() const { return projection_.ellipsoidal(); }

 private:
  TerrainFile(Elevation elevation, Projection projection)
      : elevation_(std::move(elevation)), projection_(std::move(projection)) {}

  Elevation elevation_;
  Projection projection_;
};

}  // namespace canyon::scene
