#include "canyon/scene/elevation/elevation.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/lower_case.h"

namespace canyon::scene {

std::optional<double> Elevation::height(const Eigen::Vector2d& p) const {
  const double u = (p.x() - west) / step_x, v = (north - p.y()) / step_y;
  if (!(u >= 0.0 && v >= 0.0 && u <= columns - 1 && v <= rows - 1)) return std::nullopt;
  const int c = std::min(static_cast<int>(u), std::max(columns - 2, 0));
  const int r = std::min(static_cast<int>(v), std::max(rows - 2, 0));
  const double du = u - c, dv = v - r;
  const int c1 = std::min(c + 1, columns - 1), r1 = std::min(r + 1, rows - 1);
  const double top = (1.0 - du) * at(c, r) + du * at(c1, r), bottom = (1.0 - du) * at(c, r1) + du * at(c1, r1);
  const double h = (1.0 - dv) * top + dv * bottom;
  return std::isfinite(h) ? std::optional<double>(h) : std::nullopt;
}

Result<Elevation> read_elevation(const std::string& path) {
  struct Format {
    const char* ending;
    Result<Elevation> (*read)(const std::string&);
  };
  constexpr Format kFormats[] = {{".tif", read_geotiff},      {".tiff", read_geotiff}, {".hgt", read_srtm},
                                 {".hgt.zip", read_srtm},     {".hgt.gz", read_srtm},  {".asc", read_ascii_grid},
                                 {".asc.gz", read_ascii_grid}};
  const std::string name = lower_case(path);
  for (const Format& format : kFormats)
    if (name.ends_with(format.ending)) return format.read(path);
  return Error{path, 0, "", "a terrain format that is not known",
               "a file that ends with .tif, .tiff, .hgt, .hgt.zip, .hgt.gz or .asc"};
}

}  // namespace canyon::scene
