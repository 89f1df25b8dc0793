#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// A triangle of a building's shell.
struct SolidFace {
  std::array<Eigen::Vector3d, 3> corners;
  std::uint32_t triangle = 0;  ///< of the mesh
  bool bottom = false;         ///< its file says that it is of the bottom
};

/// Where a building's shell ends below.
struct SolidBottom {
  std::vector<std::vector<Eigen::Vector3d>> rings;  ///< outlines clockwise seen from above, yards the other way
  std::vector<std::uint32_t> triangles;             ///< of the mesh; none: the shell is open below
};

/// The faces that are said to be the bottom, else those that look down, else what a shell that is open below ends in.
SolidBottom bottom_of(const std::vector<SolidFace>& faces);

/// Triangles that fill the rings of a bottom, as places seen from above, and look down.
std::vector<std::array<Eigen::Vector2d, 3>> floor_of(const SolidBottom& bottom);

}  // namespace canyon::scene
