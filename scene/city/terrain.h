#pragma once

#include <vector>

#include "canyon/scene/city/city.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::scene::city {

/// The ground: a mean slope rising to the north-east with smooth hills on top, on a regular grid of triangles, 0 at W's
/// origin.
class Terrain {
 public:
  explicit Terrain(const CityConfig& config);

  /// Height of the triangle mesh at x, y (clamped to the square).
  double height(double x, double y) const;
  Eigen::Vector3d normal(double x, double y) const;
  /// Lowest and highest ground under an outline's bounding rectangle.
  struct Span {
    double low_m, high_m;
  };
  Span span(double x0, double y0, double x1, double y1) const;

  /// Gives the cells whose centres lie in a rectangle a material.
  void paint(double x0, double y0, double x1, double y1, std::uint16_t material);
  void add_to(SceneParts& parts) const;

 private:
  std::size_t vertex(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(n_ + 1) + static_cast<std::size_t>(column);
  }

  int n_;          ///< cells per side
  double half_m_;  ///< half the edge of the square
  double cell_m_;
  std::vector<float> height_m_;
  std::vector<std::uint16_t> material_;
};

}  // namespace canyon::scene::city
