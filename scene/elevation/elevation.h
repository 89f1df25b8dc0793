#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"
#include "canyon/scene/importers/raw_scene.h"

namespace canyon::scene {

/// Heights of the ground on a regular grid of a map. Places are in the units of its coordinate system: metres, or
/// degrees of longitude and latitude.
struct Elevation {
  SourceFrame frame;
  double west = 0.0, north = 0.0;     ///< where the first sample stands
  double step_x = 1.0, step_y = 1.0;  ///< between samples, to the east and to the south
  int columns = 0, rows = 0;
  std::vector<float> height_m;  ///< rows from the north; NaN: not known

  float at(int column, int row) const {
    return height_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(column)];
  }
  /// Bilinear between the four samples around; nullopt outside, or where one of them is not known.
  std::optional<double> height(const Eigen::Vector2d& p) const;
};

/// Samples that one file may hold.
inline constexpr double kLargestGrid = 4e8;

/// GeoTIFF (.tif, .tiff), SRTM (.hgt, also zipped or gzipped), ESRI ASCII grid (.asc).
Result<Elevation> read_elevation(const std::string& path);

Result<Elevation> read_geotiff(const std::string& path);
Result<Elevation> read_srtm(const std::string& path);
Result<Elevation> read_ascii_grid(const std::string& path);

}  // namespace canyon::scene
