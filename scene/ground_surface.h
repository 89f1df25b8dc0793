#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "scene/scene.h"

namespace canyon::scene {

/// Heights on a regular grid of W, rows from the south: the ground of an imported scene before it becomes triangles.
struct GroundGrid {
  double west_m = 0.0, south_m = 0.0, cell_m = 1.0;
  int columns = 0, rows = 0;  ///< of corners
  std::vector<double> height_m;

  double x(int column) const { return west_m + column * cell_m; }
  double y(int row) const { return south_m + row * cell_m; }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

/// A grid over a rectangle; at least one cell each way. Heights are 0.
GroundGrid ground_grid(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell_m);

/// Fills the grid from a function of x, y; corners where it knows nothing take the mean of their known neighbours, ring
/// by ring outwards. False if it knows nothing anywhere.
bool fill_ground(GroundGrid& grid, const std::function<std::optional<double>(const Eigen::Vector2d&)>& height);

/// Fills the grid with the smooth surface through scattered heights: at each corner the plane that fits the heights
/// around it best, weighted by exp(-d^2 / 2 s^2), s = 25 m, or as wide as it takes for eight of them (local linear
/// regression; Cleveland & Devlin 1988). Without heights: 0.
void fit_ground(GroundGrid& grid, const std::vector<Eigen::Vector3d>& heights);

/// Adds the grid as one terrain object.
void add_ground(const GroundGrid& grid, const std::string& material, SceneParts& parts);

}  // namespace canyon::scene
