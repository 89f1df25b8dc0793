#pragma once

#include <cstdint>
#include <string_view>

#include "canyon/core/earth/earth.h"

namespace canyon {

/// A geoid on a grid, in GeographicLib's format: a 16-bit PGM of rows from north to south and columns from Greenwich
/// eastward, poles included, with "# Offset" and "# Scale" (metres).
class GeoidGrid {
 public:
  /// The text must outlive this. Throws for what is no such file: it is a file of our own.
  explicit GeoidGrid(std::string_view pgm);

  /// By Lagrange's polynomial through 10 x 10 points: a field that is limited to degree 360 is sampled at half a degree
  /// just often enough, and the usual four points would miss it by 2 m in steep places.
  double undulation_m(const Geodetic& g) const;

 private:
  static constexpr int kPoints = 10;
  /// Rows beyond a pole go on along the meridian opposite.
  double at(int row, int column) const;

  std::string_view samples_;
  int columns_ = 0, rows_ = 0;
  double offset_m_ = 0.0, scale_m_ = 0.0;
};

}  // namespace canyon
