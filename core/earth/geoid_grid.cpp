#include "canyon/core/earth/geoid_grid.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

/// Weights of the points -(n/2 - 1) ... n/2 at 0 <= t < 1.
template <std::size_t N>
std::array<double, N> lagrange_weights(double t) {
  std::array<double, N> weights;
  constexpr int kFirst = 1 - static_cast<int>(N / 2);
  for (int i = 0; i < static_cast<int>(N); ++i) {
    double w = 1.0;
    for (int j = 0; j < static_cast<int>(N); ++j)
      if (j != i) w *= (t - (kFirst + j)) / (i - j);
    weights[static_cast<std::size_t>(i)] = w;
  }
  return weights;
}

/// The number after a comment's key, or the size's line.
double number_after(std::string_view header, const std::string& key) {
  const std::size_t at = header.find(key);
  CANYON_CHECK(at != std::string_view::npos, "a geoid grid without ", key);
  return std::stod(std::string(header.substr(at + key.size(), 20)));
}

}  // namespace

GeoidGrid::GeoidGrid(std::string_view pgm) {
  constexpr std::string_view kDepth = "\n65535\n";
  const std::size_t end = pgm.find(kDepth);
  CANYON_CHECK(pgm.starts_with("P5\n") && end != std::string_view::npos, "not a 16-bit PGM");
  const std::string header(pgm.substr(0, end));
  offset_m_ = number_after(header, "# Offset ");
  scale_m_ = number_after(header, "# Scale ");
  const std::string size = header.substr(header.rfind('\n') + 1);
  CANYON_CHECK(std::sscanf(size.c_str(), "%d %d", &columns_, &rows_) == 2 && columns_ == 2 * (rows_ - 1), "a grid of ",
               size);
  samples_ = pgm.substr(end + kDepth.size());
  CANYON_CHECK(samples_.size() == 2 * static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
               "a grid of ", size, " with ", samples_.size(), " bytes");
}

double GeoidGrid::at(int row, int column) const {
  if (row < 0 || row >= rows_) {
    row = row < 0 ? -row : 2 * (rows_ - 1) - row;
    column += columns_ / 2;
  }
  column = (column % columns_ + columns_) % columns_;
  const auto i =
      2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column));
  const int high = static_cast<unsigned char>(samples_[i]), low = static_cast<unsigned char>(samples_[i + 1]);
  return offset_m_ + scale_m_ * (256 * high + low);
}

double GeoidGrid::undulation_m(const Geodetic& g) const {
  CANYON_CHECK(std::abs(g.lat_rad) <= 0.5 * kPi && std::isfinite(g.lon_rad), "lat_rad = ", g.lat_rad,
               ", lon_rad = ", g.lon_rad);
  const double per_rad = columns_ / (2.0 * kPi);
  const double y = (0.5 * kPi - g.lat_rad) * per_rad, x = std::remainder(g.lon_rad, 2.0 * kPi) * per_rad;
  const auto row = static_cast<int>(std::floor(y)), column = static_cast<int>(std::floor(x));
  const auto wy = lagrange_weights<kPoints>(y - row), wx = lagrange_weights<kPoints>(x - column);
  double sum_m = 0.0;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j)
      sum_m += wy[static_cast<std::size_t>(i)] * wx[static_cast<std::size_t>(j)] *
               at(row + 1 - kPoints / 2 + i, column + 1 - kPoints / 2 + j);
  return sum_m;
}

}  // namespace canyon
